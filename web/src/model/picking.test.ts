import { describe, expect, it } from "vitest";
import { clustered, distance, pickPoint, pickStrip, strips } from "./picking";

const lanes = strips([
  { id: 1, width: 3, centre: [[0, 0], [100, 0]] as [number, number][] },
  { id: 2, width: 3, centre: [[0, 3], [100, 3]] as [number, number][] },
  { id: 3, width: 3, centre: [[50, -40], [50, -10], [80, -10]] as [number, number][] },
  { id: 4, width: 3, centre: [[0, 0]] as [number, number][] },
]);

describe("picking a lane", () => {
  it("takes the lane under the pointer, and of two the one whose middle is nearer", () => {
    expect(pickStrip(lanes, { x: 40, y: 0.9 }, 0)?.id).toBe(1);
    expect(pickStrip(lanes, { x: 40, y: 1.7 }, 0)?.id).toBe(2);
  });

  it("reaches beyond the edge as far as it is told, and no farther", () => {
    expect(pickStrip(lanes, { x: 40, y: 6.4 }, 2)?.id).toBe(2);
    expect(pickStrip(lanes, { x: 40, y: 6.6 }, 2)).toBeUndefined();
    expect(pickStrip(lanes, { x: 104, y: 0 }, 2)).toBeUndefined();
  });

  it("is the same as looking at every point of every lane", () => {
    const near = (x: number, y: number) => {
      const away = lanes.map((lane) => ({ lane, away: dense(lane.centre, x, y) }));
      const [first] = away.filter(({ away: d, lane }) => d <= lane.width / 2 + 1).sort((a, b) => a.away - b.away);
      return first?.lane.id;
    };
    for (let x = -3; x < 105; x += 7.3) {
      for (let y = -45; y < 9; y += 2.17) expect(pickStrip(lanes, { x, y }, 1)?.id).toBe(near(x, y));
    }
  });

  it("knows no line of one point", () => expect(lanes.map(({ id }) => id)).toEqual([1, 2, 3]));
});

/** Distance from a line by looking at a point every centimetre. */
function dense(line: [number, number][], x: number, y: number): number {
  let least = Number.POSITIVE_INFINITY;
  for (let at = 0; at + 1 < line.length; at += 1) {
    const [[ax, ay], [bx, by]] = [line[at] as [number, number], line[at + 1] as [number, number]];
    const count = Math.ceil(Math.hypot(bx - ax, by - ay) * 100);
    for (let step = 0; step <= count; step += 1) {
      const share = step / count;
      least = Math.min(least, Math.hypot(x - ax - (bx - ax) * share, y - ay - (by - ay) * share));
    }
  }
  return least;
}

describe("the distance from a line", () => {
  it("is that from its nearest point, at its ends too", () => {
    expect(distance([[0, 0], [10, 0]], { x: 5, y: -4 })).toBe(4);
    expect(distance([[0, 0], [10, 0]], { x: 13, y: 4 })).toBe(5);
    expect(distance([[2, 2], [2, 2]], { x: 2, y: 5 })).toBe(3);
  });
});

describe("picking a point", () => {
  it("takes the nearest within reach", () => {
    const points = [
      { x: 0, y: 0, name: "a" },
      { x: 2, y: 0, name: "b" },
    ];
    expect(pickPoint(points, { x: 1.2, y: 0 }, 1)?.name).toBe("b");
    expect(pickPoint(points, { x: 1.2, y: 3 }, 1)).toBeUndefined();
  });
});

describe("clusters", () => {
  const points = Array.from({ length: 200 }, (_, at) => ({ x: (at * 37) % 101, y: (at * 53) % 97, at }));

  it("hold every point once, near to where it is", () => {
    for (const size of [1, 5, 20, 300]) {
      const all = clustered(points, size);
      expect(all.flatMap(({ members }) => members.map(({ at }) => at)).sort((a, b) => a - b)).toEqual(
        points.map(({ at }) => at),
      );
      for (const { x, y, members } of all) {
        // A cell is at most √2 times the size wide, so its diagonal is at most twice as long.
        for (const member of members) expect(Math.hypot(member.x - x, member.y - y)).toBeLessThanOrEqual(2 * size);
      }
    }
  });

  it("are the points themselves when these are far apart", () => {
    expect(clustered(points, 0.25)).toHaveLength(points.length);
  });
});
