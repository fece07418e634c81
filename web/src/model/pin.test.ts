import { expect, test } from "vitest";
import { onTop, pinsOf } from "./pin";

const rows = [5, 4, 3, 2, 1].map((run) => ({ run }));
const order = (base: number | undefined, ...pins: number[]) => onTop(rows, base, new Set(pins)).map(({ run }) => run);

test("the baseline is first, then what is pinned, then the others as they were", () => {
  expect(order(2, 1, 4)).toEqual([2, 1, 4, 5, 3]);
  expect(order(undefined, 3)).toEqual([3, 5, 4, 2, 1]);
  expect(order(2, 2)).toEqual([2, 5, 4, 3, 1]);
  expect(order(undefined)).toEqual([5, 4, 3, 2, 1]);
});

test("who is not in the table is not there", () => expect(order(9, 8, 1)).toEqual([1, 5, 4, 3, 2]));

test("an address may say anything", () => expect(pinsOf("3,x,3,-1,7.5,2")).toEqual([3, 2]));
