import { describe, expect, it } from "vitest";
import { moved } from "../../model/editing/deed";
import type { Editing, Item } from "../../model/editing/item";
import type { Marks, Question } from "../../model/editing/mark";
import { intoBody, onLevel, type Place, type Ray, seen } from "../../model/editing/sight";
import { strips } from "../../model/picking";
import { Hand, type World } from "./hand";

// A street of two lanes to the east, and a car on it, seen obliquely from the south.
const lane = (index: number, y: number) => ({
  id: index, road: "a", index, width: 3, speed: 14, internal: false, open: true, centre: [[0, y], [200, y]] as [number, number][],
});
const lanes = strips([lane(0, 0), lane(1, 3)]);
const line: [number, number][] = [[0, 0], [200, 0]];
const body = { shape: "body", looks: "", heading: 0, colour: "", handles: [], line: [], lift: 0 };
const car = {
  path: "vehicles.ego", group: "vehicle", name: "ego", told: "", route: "way", road: "a", lane: 0, offset: 40, along: 40, station: 40, vehicles: [],
  figures: [{ ...body, path: "vehicles.ego", x: 41, y: 0, length: 4.5, width: 1.8, height: 1.5, anchor: [40, 0], line }],
} as unknown as Item;
const behind = {
  path: "script.wall", group: "object", name: "wall", told: "", vehicles: [],
  figures: [{ ...body, path: "script.wall", x: 41, y: 4, length: 6, width: 0.4, height: 2, anchor: [41, 4] }],
} as unknown as Item;
const zone = {
  path: "script.mark.when.area", group: "area", name: "mark", told: "", vehicles: [],
  figures: [{ ...body, path: "script.mark.when.area", shape: "area", x: 0, y: 0, length: 0, width: 0, height: 0, anchor: null, line: [[90, -5], [110, -5], [110, 5], [90, 5]] }],
} as unknown as Item;
const given = {
  routes: { way: { roads: ["a"] } },
  vehicles: { ego: { route: "way", position: { along: 40 }, speed: 10 } },
  script: { wall: { do: { kind: "object", shape: "wall", x: 41, y: 4, heading: 0 } } },
};
const state = { scenario: "s", revision: 0, document: given, given, duration: 30, items: [car, behind, zone], turns: [], done: [], undone: [] } as unknown as Editing;

const EYE: Place = [41, -20, 8];
const at = (x: number, y: number, z: number): Ray => ({ from: EYE, along: [x - EYE[0], y - EYE[1], z - EYE[2]] });

/** A hand with what it has been told to do, and the pointer over places of the scene. */
function handOf(more: Partial<World> = {}) {
  const did: unknown[][] = [];
  const note = (what: string) => (...how: unknown[]) => void did.push([what, ...how]);
  const world = {
    state, items: state.items, chosen: [], locked: [], tool: { is: "select" }, lanes, aloft: [], names: false,
    onChoose: note("choose"), onMove: note("move"), onPoint: note("point"), onMenu: note("menu"), onGone: note("gone"),
    onTurn: note("turn"), onPull: note("pull"), onHandle: note("handle"), ...more,
  } as World;
  let shown: Marks | undefined;
  const hand = new Hand(() => world, (marks) => (shown = marks));
  // A plan-like picture: ten pixels a metre.
  const spot = ([x, y]: Place) => [10 * x, -10 * y, 20] as const;
  const point = (phase: Question["phase"], x: number, y: number, z = 0, add = false) =>
    hand.ask({ phase, ray: at(x, y, z), at: { x: 10 * x, y: -10 * y }, add, spot });
  return { hand, world, did, point, marks: () => shown as Marks };
}

describe("a ray of sight", () => {
  it("meets the roof of a car, though the ground that is seen there lies behind it", () => {
    const ray = at(41, 0.5, 1.5);
    const ground = onLevel(ray, 0);
    expect(ground?.y).toBeGreaterThan(4);
    expect(seen(state.items, ray)?.item.name).toBe("ego");
    expect(seen(state.items, ray)?.height).toBeCloseTo(1.5, 1);
  });

  it("meets the nearer of two, the farther beside it, and what lies on the ground where no body is", () => {
    expect(seen(state.items, at(41, 0, 0.7))?.item.name).toBe("ego");
    expect(seen(state.items, at(41, 4, 1.9))?.item.name).toBe("wall");
    expect(seen(state.items, at(100, 0, 0))?.item.name).toBe("mark");
    expect(seen(state.items, at(60, 0, 0))).toBeUndefined();
  });

  it("comes into a face where that is, and not into what lies behind the eye", () => {
    const figure = { ...car.figures[0], heading: 0, x: 0, y: 0, length: 4, width: 2, height: 1.5, lift: 5 } as never;
    expect(intoBody({ from: [0, -10, 6], along: [0, 1, 0] }, figure)).toBeCloseTo(9);
    expect(intoBody({ from: [0, -10, 6], along: [0, -1, 0] }, figure)).toBeUndefined();
    expect(intoBody({ from: [0, -10, 4], along: [0, 1, 0] }, figure)).toBeUndefined();
  });

  it("to the sky, or along the ground, is at no place", () => {
    expect(onLevel({ from: EYE, along: [0, 1, 0.1] }, 0)).toBeUndefined();
    expect(onLevel({ from: EYE, along: [0, 1, 0] }, 0)).toBeUndefined();
    expect(onLevel({ from: EYE, along: [0, 1, -1e-4] }, 0)).toBeUndefined();
  });
});

describe("the hand in the scene", () => {
  it("drags as the plan does: the same deed, to the byte", () => {
    const { did, point, marks } = handOf({ chosen: ["vehicles.ego"] });
    expect(point("down", 41, -0.9, 0.75)).toBe(true);
    point("move", 46, -0.9, 0.75);
    expect(marks().told).toBe("chosen ego, held ego");
    point("up", 53, -0.6, 0.75);
    const [what, held, drag] = did.at(-1) as [string, Item[], { from: { x: number; y: number }; to: { x: number; y: number } }];
    expect([what, held]).toEqual(["move", [car]]);
    expect(drag.to.x - drag.from.x).toBeCloseTo(12, 1);
    const plan = { from: { x: 7, y: 7 }, to: { x: 7 + drag.to.x - drag.from.x, y: 7 + drag.to.y - drag.from.y } };
    expect(JSON.stringify(moved(state, held, drag, lanes))).toBe(JSON.stringify(moved(state, [car], plan, lanes)));
  });

  it("holds what is on a bridge on its height", () => {
    const high = { ...car, figures: [{ ...car.figures[0], lift: 6 }] } as Item;
    const { did, point, marks } = handOf({ items: [high], state: { ...state, items: [high] }, chosen: ["vehicles.ego"] });
    expect(point("down", 41, -0.9, 6.3)).toBe(true);
    point("move", 45, -0.9, 6.3);
    expect(marks().lines.flatMap(({ points }) => points).every(([, , z]) => z >= 6)).toBe(true);
    point("up", 49, -0.9, 6.3);
    const { from, to } = did.at(-1)?.[2] as { from: { x: number }; to: { x: number } };
    expect(to.x - from.x).toBeCloseTo(8, 1);
  });

  it("chooses, adds, and lets go of everything on empty ground; the camera has what the hand does not take", () => {
    const { did, point } = handOf({ chosen: ["script.wall"] });
    point("down", 41, 0, 0.7);
    point("up", 41, 0, 0.7);
    point("down", 41, 0, 0.7, true);
    expect(point("down", 60, 0)).toBe(false);
    point("up", 41, 0, 0.7);
    point("click", 60, 0);
    expect(did.filter(([what]) => what === "choose").map(([, paths]) => paths)).toEqual([
      ["vehicles.ego"], ["vehicles.ego"], ["script.wall", "vehicles.ego"], ["script.wall", "vehicles.ego"], [],
    ]);
  });

  it("chooses what a rectangle holds, beside what is chosen; a broken one nothing", () => {
    const { hand, did, point, marks } = handOf({ chosen: ["script.mark.when.area"], locked: [] });
    expect(point("down", 30, -8)).toBe(false); // the camera's
    expect(point("down", 30, -8, 0, true)).toBe(true);
    point("move", 50, 3, 0, true);
    expect(marks().rectangle).toEqual([{ x: 300, y: 80 }, { x: 500, y: -30 }]);
    point("up", 50, 2, 0, true); // the wall, at y = 4, is not within
    expect(did).toEqual([["choose", ["script.mark.when.area", "vehicles.ego"]]]);
    point("down", 30, -8, 0, true);
    point("move", 50, 6, 0, true);
    expect(hand.cancel()).toBe(true);
    expect(marks().rectangle).toBeUndefined();
    point("up", 50, 6, 0, true);
    expect(did).toHaveLength(1);
  });

  it("turns by the handle before the end", () => {
    const { did, point } = handOf({ chosen: ["script.wall"] });
    expect(point("down", 41 + 3 + 1.5, 4)).toBe(true);
    point("move", 41, 10);
    point("up", 41, 12);
    expect(did.at(-1)?.slice(0, 2)).toEqual(["turn", behind]);
    expect(did.at(-1)?.[2]).toBeCloseTo(Math.PI / 2);
  });

  it("puts what the tool is for where one clicks, on a bridge above the ground", () => {
    const bridge = { ...lane(0, 0), lift: 6, centre: [[0, 0], [200, 0]] as [number, number][] };
    const { did, point } = handOf({ tool: { is: "add", what: "tree" }, aloft: [bridge as never] });
    expect(point("down", 41, 0, 0.7)).toBe(false);
    point("click", 60, 0.5, 6);
    point("click", 60, 40, 0);
    const places = did.map(([what, place]) => [what, place]) as [string, { x: number; y: number }][];
    expect(places.map(([what]) => what)).toEqual(["point", "point"]);
    expect(places.map(([, { x, y }]) => [Math.round(x * 10) / 10, Math.round(y * 10) / 10])).toEqual([[60, 0.5], [60, 40]]);
  });

  it("lets go without a deed: by Escape, by a pointer that is gone, and when somebody deletes what is held", () => {
    const { hand, world, did, point } = handOf({ chosen: ["vehicles.ego"] });
    const begin = () => {
      point("down", 41, 0, 0.7);
      point("move", 50, 0, 0.7);
    };
    begin();
    expect(hand.cancel()).toBe(true);
    point("up", 55, 0, 0.7);
    begin();
    point("cancel", 50, 0);
    point("up", 55, 0, 0.7);
    begin();
    Object.assign(world, { state: { ...state, items: [behind, zone] }, items: [behind, zone] });
    hand.renew();
    point("up", 55, 0, 0.7);
    expect(did.map(([what]) => what)).toEqual(["gone"]);
    expect(hand.cancel()).toBe(false);
  });

  it("leaves alone what is locked", () => {
    const { point } = handOf({ locked: ["vehicles.ego"] });
    expect(point("down", 41, 0, 0.1)).toBe(false);
  });
});
