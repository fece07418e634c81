import { describe, expect, it } from "vitest";
import { entryText, readEntry, stepped } from "./entry";

describe("what is typed for a number", () => {
  it.each([
    ["0.9", 0.9, ""],
    [" -3 ", -3, ""],
    ["−3", -3, ""],
    [".5", 0.5, ""],
    ["1.", 1, ""],
    ["1e-3", 0.001, ""],
    ["0,9", 0.9, "0,9 is read as 0.9"],
    [",5", 0.5, ",5 is read as 0.5"],
    ["1,234", 1.234, "1,234 is read as 1.234"],
    ["2,5 s", 2.5, "2,5 is read as 2.5"],
  ])("%s is %s, %s", (text, value, remark) => {
    expect(readEntry(text, { unit: "s" })).toEqual({ is: "number", value, remark });
  });

  it.each(["", "  ", "-", ".", "1e", "1e-", "-,"])("“%s” is not finished", (text) => {
    expect(readEntry(text)).toEqual({ is: "unfinished" });
  });

  it.each(["1.234,5", "1,234.5", "1 000", "abc", "9m", "0x10", "Infinity", "--1"])("%s is refused in words", (text) => {
    expect(readEntry(text)).toEqual({ is: "refused", remark: expect.stringContaining("is no number: write it with a point") });
  });

  it("is refused where only whole numbers are", () => {
    expect(readEntry("0,9", { whole: true })).toEqual({ is: "refused", remark: "0,9 is no whole number" });
    expect(readEntry("9", { whole: true })).toMatchObject({ value: 9 });
    expect(readEntry("1e999")).toEqual({ is: "refused", remark: "1e999 is too large" });
  });
});

describe("a field for a number", () => {
  it("shows what it is set to", () => {
    expect([entryText(1.23456, { unit: "s", decimals: 3 }), entryText(-0, {}), entryText("")]).toEqual(["1.235 s", "0", ""]);
  });

  it("goes by steps, without what rounding adds, and stays within its limits", () => {
    expect([stepped(0.1, 0.2), stepped(0.3, -0.1), stepped(0.95, 0.1, 0, 1), stepped(0, -1, 0)]).toEqual([0.3, 0.2, 1, 0]);
  });
});
