import { expect, test } from "vitest";
import { isIgnored, listOf } from "./ignored";

test.each([
  ["radio.kind", ["radio.kind"], true],
  ["radio.kind", ["radio"], true],
  ["radio.kind", ["radio.*"], true],
  ["radios.kind", ["radio.*"], false],
  ["radio", ["radio.kind"], false],
  ["host", [], false],
])("%s with %j: %j", (name, list, ignored) => expect(isIgnored(name, list)).toBe(ignored));

test("a list is what stands between commas and lines; a star alone is not everything", () => {
  expect(listOf(" host, radio.* ,\nhost\n, *")).toEqual(["host", "radio.*"]);
});
