import { describe, expect, it } from "vitest";
import { nameFor, placeOrBox } from "./place";

describe("a place or a box", () => {
  it("is a box when it is four numbers, however they are parted", () => {
    expect(placeOrBox("13.34, 52.51,13.36 52.52")).toEqual({ bbox: [13.34, 52.51, 13.36, 52.52] });
    expect(placeOrBox("-0.1;51.4;0.1;51.6")).toEqual({ bbox: [-0.1, 51.4, 0.1, 51.6] });
  });

  it("is a place otherwise", () => {
    expect(placeOrBox(" Großer Stern, Berlin ")).toEqual({ place: "Großer Stern, Berlin" });
    expect(placeOrBox("1, 2, 3")).toEqual({ place: "1, 2, 3" });
  });
});

describe("the name of an upload", () => {
  const file = { name: "Extract.OSM.gz" };
  it("keeps the ending, which tells what the file holds", () => {
    expect(nameFor(file, "")).toBe("Extract.OSM.gz");
    expect(nameFor(file, " Seattle ")).toBe("Seattle.osm.gz");
    expect(nameFor(file, "Seattle.osm.gz")).toBe("Seattle.osm.gz");
    expect(nameFor({ name: "notes.txt" }, "Seattle")).toBe("Seattle");
  });
});
