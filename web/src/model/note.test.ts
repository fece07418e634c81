import { expect, test } from "vitest";
import { blocksOf, piecesOf, plain } from "./note";

test("a line has its strong, emphasised and literal parts, and its times", () => {
  expect(piecesOf("Look at @12.3 s: **late**, `acc` *slow*")).toEqual([
    { is: "text", text: "Look at " },
    { is: "time", text: "@12.3 s", time: 12.3 },
    { is: "text", text: ": " },
    { is: "strong", text: "late" },
    { is: "text", text: ", " },
    { is: "code", text: "acc" },
    { is: "text", text: " " },
    { is: "emphasis", text: "slow" },
  ]);
});

test.each(["ada@12.org", "2 * 3 * 4", "a@b", "@", "@12x", "**", "[a](javascript:alert(1))", "[a](data:text/html,x)"])("%j is text and nothing else", (line) =>
  expect(piecesOf(line).every(({ is }) => is === "text")).toBe(true),
);

test("a time ends with its sentence", () => {
  expect(piecesOf("at @7.")).toEqual([{ is: "text", text: "at " }, { is: "time", text: "@7", time: 7 }, { is: "text", text: "." }]);
});

test("HTML stays text", () => {
  expect(blocksOf("<img src=x onerror=alert(1)>")).toEqual([{ is: "paragraph", pieces: [{ is: "text", text: "<img src=x onerror=alert(1)>" }] }]);
});

test("blocks are headings, lists, paragraphs over lines, and code as it stands", () => {
  const found = blocksOf("# Why\none\ntwo\n\n- a\n- **b**\n1. c\n```\n*x*\n```\nend");
  expect(found.map(({ is }) => is)).toEqual(["heading", "paragraph", "list", "list", "code", "paragraph"]);
  expect(found[1]).toEqual({ is: "paragraph", pieces: [{ is: "text", text: "one" }, { is: "text", text: " " }, { is: "text", text: "two" }] });
  expect(found[4]).toEqual({ is: "code", text: "*x*" });
});

test("in tables a note is a line", () => {
  expect(plain("# Why\nlate at @3 s\n- **a**\n- [b](https://example.org)")).toBe("Why; late at @3 s; a; b");
});
