import { describe, expect, it } from "vitest";
import { type Arrow, isChanged, numberOf, profileOf, roadOf, settled, signalTags, tagsOf, turnText, UNCHANGED, wrong } from "./correction";
import type { Plan } from "./map";

const lane = (id: number, road: string, index: number) => ({
  id,
  road,
  index,
  width: 3.25,
  speed: 50 / 3.6,
  internal: false,
  open: true,
  centre: [] as [number, number][],
});
const plan = {
  lanes: [lane(0, "7", 0), lane(1, "7", 1), lane(2, "-7", 0), lane(3, "8#1", 1), lane(4, "8#1", 0), lane(5, "8#0", 0)],
  roads: [
    { id: "-7", name: "Street", lanes: [2], ways: [7] },
    { id: "7", name: "Street", lanes: [0, 1], ways: [7] },
    { id: "8#0", name: "", lanes: [5], ways: [8] },
    { id: "8#1", name: "", lanes: [4, 3], ways: [8, 9] },
  ],
} as unknown as Plan;
const road = (id: string) => plan.roads.find((each) => each.id === id) as Plan["roads"][number];
const twoWay = profileOf(plan, road("7"), 7);
const oneWay = profileOf(plan, road("8#1"), 8);

describe("what a way is taken to be", () => {
  it("counts the lanes of each direction, the most of any piece", () => {
    expect(twoWay).toEqual({ along: true, forward: 2, backward: 1, speed: 50, laneWidth: 3.25 });
    expect(profileOf(plan, road("-7"), 7)).toMatchObject({ along: false, forward: 2, backward: 1 });
    expect(oneWay).toMatchObject({ forward: 2, backward: 0 });
  });

  it("is seen from the road along it", () => {
    expect(roadOf(plan, 7)?.id).toBe("7");
    expect(roadOf(plan, 10)).toBeUndefined();
  });
});

describe("the tags of a change", () => {
  it("count the lanes of a one-way way once, and of another for each direction and both", () => {
    expect(tagsOf({ ...UNCHANGED, forward: 3 }, oneWay)).toEqual({ lanes: "3" });
    expect(tagsOf({ ...UNCHANGED, backward: 2 }, twoWay)).toEqual({
      lanes: "4",
      "lanes:forward": "2",
      "lanes:backward": "2",
    });
  });

  it("give the limit in km/h", () => expect(tagsOf({ ...UNCHANGED, speed: 30 }, oneWay)).toEqual({ maxspeed: "30" }));

  it("give the width of the whole way, with the lanes as they will be", () => {
    expect(tagsOf({ ...UNCHANGED, laneWidth: 3 }, twoWay)).toEqual({ width: "9" });
    expect(tagsOf({ ...UNCHANGED, laneWidth: 2.75, forward: 1 }, oneWay)).toEqual({ lanes: "1", width: "2.75" });
  });

  it("name the direction of the arrows where there are two", () => {
    const turns: Arrow[][] = [["left"], ["right", "through"]];
    expect(tagsOf({ ...UNCHANGED, turns }, oneWay)).toEqual({ "turn:lanes": "left|through;right" });
    expect(tagsOf({ ...UNCHANGED, turns }, twoWay)).toEqual({ "turn:lanes:forward": "left|through;right" });
    expect(tagsOf({ ...UNCHANGED, turns }, { ...twoWay, along: false })).toEqual({
      "turn:lanes:backward": "left|through;right",
    });
  });

  it("are none without a change", () => {
    expect(tagsOf(UNCHANGED, twoWay)).toEqual({});
    expect(isChanged(UNCHANGED)).toBe(false);
    expect(isChanged({ ...UNCHANGED, speed: 30 })).toBe(true);
  });
});

describe("a guess that is right", () => {
  it("is confirmed by the tags that say what was taken", () => {
    expect(tagsOf(settled(UNCHANGED, oneWay, ["lanes"]), oneWay)).toEqual({ lanes: "2" });
    expect(tagsOf(settled(UNCHANGED, twoWay, ["lanes"]), twoWay)).toEqual({
      lanes: "3",
      "lanes:forward": "2",
      "lanes:backward": "1",
    });
    expect(tagsOf(settled(UNCHANGED, twoWay, ["speed"]), twoWay)).toEqual({ maxspeed: "50" });
    expect(tagsOf(settled({ ...UNCHANGED, laneWidth: 3 }, oneWay, ["width"]), oneWay)).toEqual({ width: "6" });
  });
});

describe("arrows", () => {
  it("stand in the order of directions, whatever was pressed first; a lane may have none", () => {
    expect(turnText([["through", "left"], [], ["slight_right"]])).toBe("left;through||slight_right");
  });
});

describe("a signal", () => {
  it("is put there or taken away", () => {
    expect(signalTags(true)).toEqual({ tags: { highway: "traffic_signals" }, remove: [] });
    expect(signalTags(false)).toEqual({ tags: {}, remove: ["highway"] });
  });
});

describe("what cannot be sent", () => {
  it.each([
    [{ forward: 0 }, "Lanes: 1 to 16"],
    [{ forward: 1.5 }, "Lanes: a whole number"],
    [{ backward: 99 }, "Lanes: 1 to 16"],
    [{ speed: Number.NaN }, "Speed limit: 5 to 250 km/h"],
    [{ laneWidth: 9 }, "Lane width: 2.5 to 4.5 m"],
  ])("%o is told", (part, text) => expect(wrong({ ...UNCHANGED, ...part })).toBe(text));

  it("is nothing that is in range", () => {
    expect(wrong({ ...UNCHANGED, forward: 2, speed: 30, laneWidth: 3 })).toBe("");
  });
});

describe("the number of an element", () => {
  it("is that of its own kind only", () => {
    expect(numberOf("way 4711", "way")).toBe(4711);
    expect(numberOf("node 7", "way")).toBeUndefined();
    expect(numberOf("", "way")).toBeUndefined();
  });
});
