import { describe, expect, it } from "vitest";
import { layoutOf, needed, otherUnit, timeSetup, USUAL, withChannel, without, withoutChannel } from "./layout";

const UNITS: Record<string, string> = { speed: "m/s", gap: "m", yaw_rate: "rad/s", acceleration: "m/s²" };
const unitOf = (name: string) => UNITS[name.slice(name.indexOf(".") + 1)] ?? "1";

describe("the charts of a scenario", () => {
  it("are read as they were kept, and the usual ones when nothing was", () => {
    const kept = [timeSetup("gap", ["a.speed"]), { form: "xy", x: "gap", y: "speed" }] as const;
    expect(layoutOf(JSON.parse(JSON.stringify(kept)))).toEqual(kept);
    expect(layoutOf(undefined)).toEqual(USUAL);
    expect(layoutOf([{ form: "pie" }, 7, { form: "xy", x: 1 }] as never)).toEqual(USUAL);
  });

  it("take channels of one other unit on a second axis, and give a third unit a chart of its own", () => {
    const two = withChannel([timeSetup("speed")], 0, "traffic_01.gap", unitOf);
    expect(two).toEqual([timeSetup("speed", ["traffic_01.gap"])]);
    expect(otherUnit(two[0] as never, unitOf)).toBe("m");
    const same = withChannel(two, 0, "traffic_02.speed", unitOf);
    expect(same).toHaveLength(1);
    const three = withChannel(same, 0, "leader.yaw_rate", unitOf);
    expect(three[1]).toEqual(timeSetup("yaw_rate", ["leader.yaw_rate"]));
    expect(withChannel(two, 0, "traffic_01.gap", unitOf)).toBe(two);
  });

  it("lose channels and charts again, but never the last chart", () => {
    expect(withoutChannel(timeSetup("speed", ["a.gap", "b.gap"]), "a.gap")).toEqual(timeSetup("speed", ["b.gap"]));
    expect(without(USUAL, 0)).toEqual([timeSetup("gap")]);
    expect(without([timeSetup("gap")], 0)).toEqual([timeSetup("gap")]);
  });

  it("ask for every recorded channel once", () => {
    const drawn = (quantity: string) => [`a.${quantity}`, `b.${quantity}`];
    const known = new Set(["a.speed", "b.speed", "a.gap"]);
    expect(needed([timeSetup("speed", ["a.gap"]), { form: "xy", x: "gap", y: "speed" }], drawn, known)).toEqual(["a.speed", "b.speed", "a.gap"]);
  });
});
