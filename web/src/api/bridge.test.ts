import { describe, expect, it } from "vitest";
import { PATIENCE, Rebuilding } from "./bridge";

describe("a scene that is built again", () => {
  const watch = () => {
    const parts: { road: unknown; vehicles: unknown } = { road: undefined, vehicles: undefined };
    return { parts, scene: new Rebuilding(() => parts) };
  };
  const looks = (scene: Rebuilding, times: number) => Array.from({ length: times }, () => scene.look());
  const show = (parts: object) => Object.assign(parts, { road: {}, vehicles: {} });

  it("is not one that comes up for the first time", () => {
    const { parts, scene } = watch();
    expect(new Set(looks(scene, 2 * PATIENCE))).toEqual(new Set(["same"]));
    show(parts);
    expect(new Set(looks(scene, 5))).toEqual(new Set(["same"]));
  });

  it("is noticed once, a look after everything is there again", () => {
    const { parts, scene } = watch();
    show(parts);
    scene.look();
    show(parts);
    expect(looks(scene, 4)).toEqual(["same", "rebuilt", "same", "same"]);
  });

  it("has been emptied when nothing comes back for long", () => {
    const { parts, scene } = watch();
    const { road } = show(parts);
    scene.look();
    Object.assign(parts, { vehicles: undefined });
    expect(looks(scene, PATIENCE).at(-1)).toBe("emptied");
    Object.assign(parts, { road, vehicles: {} });
    expect(looks(scene, 2)).toEqual(["same", "rebuilt"]);
  });
});
