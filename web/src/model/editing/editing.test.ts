import { describe, expect, it } from "vitest";
import type { Section } from "../form";
import { strips } from "../picking";
import { area, copied, ghostOf, isAbsolute, isTurnable, moved, nudged, pasted, placed, staying, turnedTo, whereabouts } from "./deed";
import { fitted, outside, sectionAt, stepName } from "./form";
import { settingsFor } from "./fresh";
import { boundsOfItems, hit, within } from "./hit";
import { cornerAdded, cornerMoved, cornerRemoved, endMoved, endsOf, knobsOf, LONGEST_WALL, walls } from "./shape";
import { type Editing, freshName, grouped, type Item, named, present, toggled } from "./item";
import { corners, foot, inside, pointAt, rounded } from "./line";

// A street of two lanes to the east, and a car 40 m from its beginning.
const lane = (road: string, index: number, y: number) => ({
  id: index, road, index, width: 3, speed: 14, internal: false, open: true, centre: [[0, y], [200, y]] as [number, number][],
});
const lanes = strips([lane("a", 0, 0), lane("a", 1, 3), lane("b", 0, 50)]);
const line: [number, number][] = [[0, 0], [200, 0]];
const car: Item = {
  path: "vehicles.ego", group: "vehicle", name: "ego", told: "a car", route: "way", road: "a", lane: 0, offset: 40, along: 40, station: 40, vehicles: [],
  figures: [{ path: "vehicles.ego", shape: "body", looks: "", x: 41, y: 0, heading: 0, length: 4.5, width: 1.8, height: 1.5, lift: 0, anchor: [40, 0], line, colour: "#0072b2", handles: [] }],
} as Item;
const tree: Item = {
  path: "script.tree", group: "object", name: "tree", told: "a tree stands there", vehicles: [],
  figures: [{ path: "script.tree", shape: "body", looks: "tree", x: 60, y: 20, heading: 0, length: 0.4, width: 0.4, anchor: [60, 20], line: [], colour: "", handles: [] }],
} as unknown as Item;
const walker: Item = {
  path: "script.child", group: "person", name: "child", told: "pedestrian moves", vehicles: [],
  figures: [{ path: "script.child", shape: "body", looks: "pedestrian", x: 80, y: -6, heading: Math.PI / 2, length: 0.6, width: 0.5, anchor: [80, -6], line: [[80, -6], [80, 6]], colour: "", handles: [] }],
} as unknown as Item;
const zone: Item = {
  path: "script.mark.when.area", group: "area", name: "mark", told: "area of mark", vehicles: [],
  figures: [{ path: "script.mark.when.area", shape: "area", line: [[90, -5], [110, -5], [110, 5], [90, 5]], anchor: null, handles: [] }],
} as unknown as Item;
const route: Item = { path: "routes.way", group: "route", name: "way", told: "200 m", vehicles: [], figures: [{ path: "routes.way", shape: "line", line, handles: [] }] } as unknown as Item;

const given = {
  routes: { way: { roads: ["a"] } },
  vehicles: { ego: { route: "way", position: { along: 40 }, speed: 10 } },
  script: {
    tree: { do: { kind: "object", shape: "tree", x: 60, y: 20, heading: 0 } },
    child: { do: { kind: "mover", who: "pedestrian", line: [[80, -6], [80, 6]] } },
    ahead: { do: { kind: "mover", who: "cyclist", route: "way", line: [[100, 1], [150, 1]] } },
    mark: { when: { kind: "in_area", vehicle: "ego", area: { corners: [[90, -5], [110, -5], [110, 5], [90, 5]] } }, do: { kind: "mark" } },
  },
};
const state = { scenario: "s", revision: 0, document: given, given, duration: 30, items: [car, tree, walker, zone, route], turns: [], done: [], undone: [] } as unknown as Editing;
const values = (patch: unknown) => Object.fromEntries((patch as { path: string; value: unknown }[]).map(({ path, value }) => [path, value]));

const wall: Item = {
  path: "script.wall", group: "object", name: "wall", told: "a wall stands there", vehicles: [],
  figures: [{ path: "script.wall", shape: "body", looks: "wall", x: 20, y: 10, heading: Math.PI / 2, length: 4, width: 0.25, anchor: [20, 10], line: [], colour: "", handles: [] }],
} as unknown as Item;
const built = {
  ...state,
  document: { ...given, script: { ...given.script, wall: { do: { kind: "object", shape: "wall", x: 20, y: 10, heading: Math.PI / 2, length: null } } } },
} as unknown as Editing;

describe("shapes, corner by corner", () => {
  const ring = [[90, -5], [110, -5], [110, 5], [90, 5]];
  const cornersOf = (deed: ReturnType<typeof cornerMoved>) => values(deed?.patch)["/script/mark/when/area/corners"];

  it("have a corner moved, put on an edge, and taken out", () => {
    expect(cornersOf(cornerMoved(state, zone, 1, { x: 120, y: -7.123 }))).toEqual([ring[0], [120, -7.12], ring[2], ring[3]]);
    expect(cornersOf(cornerAdded(state, zone, 0))).toEqual([ring[0], [100, -5], ring[1], ring[2], ring[3]]);
    expect(cornersOf(cornerAdded(state, zone, 3, { x: 80, y: 0 }))).toEqual([...ring, [80, 0]]);
    expect(cornersOf(cornerRemoved(state, zone, 0))).toEqual(ring.slice(1));
  });

  it("keep as many corners as a shape needs", () => {
    const three = { ...state, document: { ...given, script: { ...given.script, mark: { when: { area: { corners: ring.slice(1) } } } } } } as unknown as Editing;
    expect(cornerRemoved(three, zone, 0)).toBeUndefined();
    expect(cornerMoved(three, zone, 3, { x: 0, y: 0 })).toBeUndefined(); // somebody else has taken it out
  });

  it("are open where somebody walks, and none along a route", () => {
    expect(values(cornerAdded(state, walker, 0)?.patch)["/script/child/do/line"]).toEqual([[80, -6], [80, 0], [80, 6]]);
    expect(knobsOf(state, walker).map(({ is }) => is)).toEqual(["corner", "corner", "edge"]);
    expect(knobsOf(state, { ...walker, path: "script.ahead" })).toEqual([]);
    expect(values(cornerRemoved(state, walker, 1)?.patch)["/script/child/do/line"]).toEqual([[80, -6]]);
  });

  it("of a wall are its two ends, of which one stays", () => {
    expect(endsOf(built, wall)?.flat().map((each) => rounded(each))).toEqual([20, 8, 20, 12]);
    const { set = {} } = endMoved(built, wall, 1, { x: 26, y: 16 }) ?? {};
    expect(set).toEqual({ "script.wall.do.x": 23, "script.wall.do.y": 12, "script.wall.do.heading": 0.927, "script.wall.do.length": 10 });
    expect(endMoved(built, wall, 1, { x: 20, y: 8 + LONGEST_WALL + 1 })).toBeUndefined();
  });

  it("of walls make a piece a side, and several of a long one", () => {
    const made = walls(built, [{ x: 0, y: 0 }, { x: 120, y: 0 }, { x: 120, y: 10 }, { x: 120, y: 10 }]);
    expect(made?.paths).toEqual(["script.wall", "script.wall_2", "script.wall_3", "script.wall_4"]);
    const pieces = Object.values(values(made?.deed.patch)).map((each) => (each as { do: { x: number; length: number } }).do);
    expect(pieces.map(({ x, length }) => [x, length])).toEqual([[20, 40], [60, 40], [100, 40], [120, 10]]);
    expect(walls(built, [{ x: 0, y: 0 }])).toBeUndefined();
  });
});

describe("lines on the ground", () => {
  it("tell where a point lies along and beside them", () => {
    expect(foot([[0, 0], [10, 0], [10, 10]], { x: 12, y: 4 })).toMatchObject({ along: 14, left: -2, x: 10, y: 4 });
    expect(pointAt([[0, 0], [10, 0], [10, 10]], 14)).toMatchObject({ x: 10, y: 4, heading: Math.PI / 2 });
    expect(pointAt(line, 999)).toMatchObject({ x: 200, y: 0 });
  });

  it("have an inside when they are closed", () => {
    const square = corners(5, 5, Math.PI / 4, 4, 4);
    expect(inside(square, { x: 5, y: 7.5 })).toBe(true);
    expect(inside(square, { x: 7, y: 7 })).toBe(false);
  });
});

describe("what is under the pointer", () => {
  it("is what lies on top, and a route only where nothing else is", () => {
    expect(hit(state.items, { x: 41, y: 0.5 }, 0.1)?.name).toBe("ego");
    expect(hit(state.items, { x: 20, y: 0 }, 0.1)?.name).toBe("way");
    expect(hit(state.items, { x: 100, y: 4 }, 0.1)?.name).toBe("mark");
    expect(hit(state.items, { x: 20, y: 30 }, 0.5)).toBeUndefined();
  });

  it("is found in a rectangle, routes left out", () => {
    expect(within(state.items, [30, -10, 120, 10]).map(({ name }) => name)).toEqual(["ego", "child", "mark"]);
    expect(boundsOfItems([tree, car])).toEqual([41, 0, 60, 20]);
  });
});

describe("a drag", () => {
  it("leaves a car on its way, at another station", () => {
    const deed = moved(state, [car], { from: { x: 41, y: 0 }, to: { x: 52, y: 1 } }, lanes);
    expect(deed?.name).toBe("Move ego");
    expect(values(deed?.patch)).toEqual({ "/vehicles/ego/position": { along: 51 } });
  });

  it("puts a car onto the other lane of its road, or says that it is off its way", () => {
    expect(whereabouts(state, car, { x: 70, y: 3.4 }, lanes)).toMatchObject({ is: "lane", road: "a", lane: 1, offset: 70 });
    expect(whereabouts(state, car, { x: 70, y: 50 }, lanes)).toEqual({ is: "off" });
    expect(moved(state, [car], { from: { x: 40, y: 0 }, to: { x: 70, y: 50 } }, lanes)).toBeUndefined();
  });

  it("shows the car where it would be, its middle before its centre of gravity as before", () => {
    expect(ghostOf(state, car, { from: { x: 40, y: 0 }, to: { x: 60, y: 1 } }, lanes)).toMatchObject({ x: 61, y: 0, heading: 0 });
  });

  it("shifts everything that is chosen, each in its own words", () => {
    const deed = moved(state, [car, tree, walker, zone], { from: { x: 0, y: 0 }, to: { x: 5, y: 1 } }, lanes);
    expect(deed?.name).toBe("Move 4 things");
    expect(values(deed?.patch)).toEqual({
      "/vehicles/ego/position": { along: 45 },
      "/script/tree/do/x": 65,
      "/script/tree/do/y": 21,
      "/script/child/do/line": [[85, -5], [85, 7]],
      "/script/mark/when/area/corners": [[95, -4], [115, -4], [115, 6], [95, 6]],
    });
  });

  it("shifts who moves along a route by as much along it and beside it", () => {
    const cyclist = { ...walker, path: "script.ahead", name: "ahead" } as Item;
    const deed = moved(state, [cyclist], { from: { x: 100, y: 1 }, to: { x: 104, y: 3 } }, lanes);
    expect(values(deed?.patch)).toEqual({ "/script/ahead/do/line": [[104, 3], [154, 3]] });
  });
});

describe("a turn", () => {
  it("sets the heading of an object, and turns the line of somebody on foot", () => {
    expect(turnedTo(state, tree, 1.5)).toEqual({ name: "Turn tree", set: { "script.tree.do.heading": 1.5 } });
    expect(values(turnedTo(state, walker, 0)?.patch)["/script/child/do/line"]).toEqual([[80, -6], [92, -6]]);
  });

  it("is nothing for a car, which looks along its way", () => expect(isTurnable(state, car)).toBe(false));
});

describe("what is added", () => {
  it("has a name of its own and stands where the click was", () => {
    const made = placed(state, "tree", { x: 10, y: 30 }, lanes);
    expect(made?.path).toBe("script.tree_2");
    expect(values(made?.deed.patch)["/script/tree_2"]).toMatchObject({ do: { shape: "tree", x: 10, y: 30 } });
  });

  it("lies on a lane when it is a friction patch, or nowhere", () => {
    expect(values(placed(state, "friction", { x: 50, y: 0.5 }, lanes)?.deed.patch)["/script/patch"]).toMatchObject({ do: { road: "a", lane: 0, start: 40, end: 60 } });
    expect(placed(state, "friction", { x: 50, y: 25 }, lanes)).toBeUndefined();
  });

  it("makes the part of the document that is not there yet", () => {
    expect(placed(state, "station", { x: 1, y: 2 }, lanes)?.deed.patch).toEqual([{ op: "add", path: "/stations", value: { unit: { position: { x: 1, y: 2 } } } }]);
  });

  it("is a trigger when it is an area", () => {
    const { deed, path } = area(state, [{ x: 0, y: 0 }, { x: 1, y: 0 }, { x: 0, y: 1 }]);
    expect(path).toBe("script.area.when.area");
    expect(values(deed.patch)["/script/area"]).toMatchObject({ when: { kind: "in_area", vehicle: "ego" } });
  });
});

describe("a copy", () => {
  it("does not stand in what it is of", () => {
    const made = pasted(state, copied(state, ["vehicles.ego", "script.tree"]));
    expect(made?.paths).toEqual(["vehicles.ego_2", "script.tree_2"]);
    const parts = values(made?.deed.patch);
    expect(parts["/vehicles/ego_2"]).toMatchObject({ route: "way", position: { along: 28 } });
    expect(parts["/script/tree_2"]).toMatchObject({ do: { x: 63, y: 17 } });
  });
});

describe("a nudge", () => {
  it("moves a car along its way only, whatever it is told", () =>
    expect(values(nudged(state, [car], 0.5, 4, lanes)?.patch)).toEqual({ "/vehicles/ego/position": { along: 40.5 } }));
});

describe("the list", () => {
  it("is searched in names and words, group by group", () => {
    expect(grouped(state.items, "").map(({ title }) => title)).toEqual(["Vehicles", "People", "Objects", "Areas", "Routes"]);
    expect(grouped(state.items, "tree stands").flatMap(({ items }) => items.map(({ name }) => name))).toEqual(["tree"]);
  });

  it("forgets who is gone, and names what is chosen", () => {
    expect(present(["vehicles.ego", "vehicles.gone"], state.items)).toEqual(["vehicles.ego"]);
    expect(toggled(["a", "b"], "a")).toEqual(["b"]);
    expect(named(["script.mark", "script.mark.when.area"])).toBe("mark");
    expect(freshName("car_2", ["car", "car_2"])).toBe("car_3");
  });
});

describe("the form", () => {
  const field = (path: string, more: object) => ({ path, label: "Speed", kind: "number", changed: true, allowed: "at most 70 m/s", maximum: 70, value: 10, initial: 5, choices: [], suggestions: [], ...more });
  const section = { path: "vehicles.ego", title: "", description: "", fields: [field("vehicles.ego.speed", {})], sections: [] } as unknown as Section;

  it("is the part of the scenario's form that is about what is chosen", () =>
    expect(sectionAt([{ ...section, path: "vehicles", sections: [section] }], "vehicles.ego")).toBe(section));

  it("tells a number that is out of its range at its field", () => {
    const wrong = { ...section, fields: [field("vehicles.ego.speed", { value: 700 })] } as unknown as Section;
    expect([...outside([wrong])]).toEqual([["vehicles.ego.speed", [expect.objectContaining({ value: "700", allowed: "at most 70 m/s" })]]]);
    expect(outside([section]).size).toBe(0);
  });

  it("offers the names that there are, and leaves out what is drawn", () => {
    const names = field("x.vehicle", { kind: "text", names: "vehicle", value: "ego" });
    const drawn = field("x.corners", { kind: "list", value: [[0, 1]] });
    const shown = fitted({ ...section, fields: [names, drawn] } as unknown as Section, state);
    expect(shown.fields).toEqual([expect.objectContaining({ kind: "choice", choices: ["ego"] })]);
  });

  it("names the step after what was changed", () => expect(stepName([section], "ego")).toBe("Change speed of ego"));
});

describe("a kind that is chosen", () => {
  const kind = (properties: object, required: string[]) => ({ sort: "condition", name: "new", settings: { properties, required } }) as never;

  it("keeps what both have, and gets what it needs", () => {
    const found = settingsFor(kind({ vehicle: { type: "string", names: "vehicle" }, along: { type: "number", minimum: 0 }, other: { type: "string", names: "body" } }, ["vehicle", "along", "other"]), { kind: "old", along: 12 }, state, { x: 0, y: 0 });
    expect(found).toEqual({ kind: "new", along: 12, vehicle: "ego", other: "tree" });
  });

  it("gets an area around what is looked at", () =>
    expect(settingsFor(kind({ area: { type: "object" } }, []), {}, state, { x: 3.4, y: 8 })).toEqual({ kind: "new", area: { x: 3, y: 8, radius: 20 } }));
});

describe("what a drag or a quick second step does", () => {
  it("tells which of several things stay behind", () => {
    const drag = { from: { x: 0, y: 0 }, to: { x: 0, y: 20 } };
    expect(staying(state, [car, tree, route], drag, lanes).map(({ name }) => name)).toEqual(["ego", "way"]);
    expect(staying(state, [car, tree], { from: { x: 0, y: 0 }, to: { x: 10, y: 0 } }, lanes)).toEqual([]);
  });

  it("follows one's own steps unseen when it says what shall stand there, not when it counts places of a list", () => {
    const patch = (op: string, path: string) => ({ name: "", patch: [{ op, path, value: 1 }] as never });
    expect(isAbsolute({ name: "", set: { "clock.duration": 3 } })).toBe(true);
    expect(isAbsolute(patch("replace", "/script/mark/when/area/corners/2"))).toBe(true);
    expect(isAbsolute(patch("remove", "/script/mark/when/of/1"))).toBe(false);
    expect(isAbsolute(patch("replace", "/script/mark/when/of/1"))).toBe(false);
    expect(isAbsolute(patch("add", "/script/event"))).toBe(false);
  });
});
