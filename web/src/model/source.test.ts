import { beforeEach, describe, expect, it } from "vitest";
import { applicationNameProblem, beneath, entitled, keepText, keptText } from "./source";

beforeEach(() => localStorage.clear());

describe("what is kept until it is saved", () => {
  it("comes back, and goes when it is saved", () => {
    keepText("mine", { text: "new", base: "old" });
    expect(keptText("mine")).toEqual({ text: "new", base: "old" });
    expect(keptText("other")).toBeNull();
    keepText("mine", { text: "new", base: "new" });
    expect(keptText("mine")).toBeNull();
  });

  it("is nothing when the browser keeps something strange", () => {
    localStorage.setItem("source mine", "{");
    expect(keptText("mine")).toBeNull();
    localStorage.setItem("source mine", "[1]");
    expect(keptText("mine")).toBeNull();
  });
});

it("tells what is no name of a Python file", () => {
  expect(applicationNameProblem("my_idea2", [])).toBe("");
  for (const name of ["", "Idea", "2nd", "my idea", "class", "test_me", "a.b"]) expect(applicationNameProblem(name, [])).not.toBe("");
  expect(applicationNameProblem("acc", ["acc"])).toContain("already");
});

it("follows a file only where nothing would be lost", () => {
  expect(beneath("a", "a", "a")).toBe("same");
  expect(beneath("b", "a", "a")).toBe("same");
  expect(beneath("a", "a", "c")).toBe("follow");
  expect(beneath("b", "a", "b")).toBe("saved");
  expect(beneath("b", "a", "c")).toBe("conflict");
});

describe("a start", () => {
  it("is called as what begins with it", () => {
    const text = '"""Mine: keeps a gap."""\nKIND = "application"\nTITLE = "Mine"\n';
    expect(entitled(text, "late_brake")).toBe('"""Late brake: keeps a gap."""\nKIND = "application"\nTITLE = "Late brake"\n');
  });
});
