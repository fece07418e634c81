import { describe, expect, it } from "vitest";
import { complete, type Vocabulary } from "./completion";

const word = (name: string, unit = "", meaning = "", words: Vocabulary["ports"][0]["words"] = [], is_row = false) => ({ name, unit, meaning, words, is_row });
const TARGET = word("target", "", "", [word("range", "m", "to the nearest point"), word("rate", "m/s")], true);
const PAYLOAD = word("payload", "", "", [word("x", "m"), word("speed", "m/s")]);

const VOCABULARY: Vocabulary = {
  ports: [
    { type: "Own", kind: "", seen: true, meaning: "the bus", words: [word("speed", "m/s", "along the car"), word("yaw_rate", "rad/s")] },
    { type: "Targets", kind: "front_radar", seen: true, meaning: "Front radar", words: [word("count"), TARGET] },
    { type: "Targets", kind: "blind_spot", seen: true, meaning: "Blind-spot sensor", words: [word("count")] },
    { type: "Inbox", kind: "cam", seen: true, meaning: "CAM", words: [word("message", "", "", [word("age", "s"), PAYLOAD], true)] },
  ],
  functions: [{ name: "accelerate", arguments: ["acceleration"], meaning: "Drive and brake" }],
  names: ["accelerate", "ACCELERATION", "Own"],
};

const HEAD = `class Parameters(Part):
    """What is tuned."""
    headway: float = number(
        1.0, unit="s", title="Time headway", description="to the car ahead", ge=0.3)
    calm: float = number(0.5, unit="1", title="Calm")


class Memory(NamedTuple):
    u: Annotated[float, "m/s²", "asked for last"] = 0.0


class Sees(NamedTuple):
    own: Own
    front: Annotated[Targets, "front_radar", 4]
    heard: Annotated[Inbox, "cam", 2]


def decide(parameters, memory, sees):
`;

const offered = (body: string, head = HEAD) => {
  const text = head + body;
  return complete(text, text.length, VOCABULARY);
};
const labels = (body: string, head?: string) => offered(body, head)?.offers.map(({ label }) => label) ?? [];

describe("completion", () => {
  it("offers the ports, and what stands below them", () => {
    expect(labels("    a = sees.")).toEqual(["own", "front", "heard"]);
    expect(labels("    a = sees.own.")).toEqual(["speed", "yaw_rate"]);
    expect(labels("    a = sees.front.target[0].")).toEqual(["range", "rate"]);
    expect(labels("    a = sees.heard.message[i + 1].payload.")).toEqual(["x", "speed"]);
  });

  it("tells unit and meaning", () => {
    expect(offered("    a = sees.own.")?.offers[0]).toEqual({ label: "speed", detail: "[m/s]", info: "along the car" });
    expect(offered("    a = sees.")?.offers[1]?.info).toBe("Front radar");
  });

  it("begins where the name begins", () => {
    const found = offered("    a = sees.own.sp");
    expect(found?.from).toBe(HEAD.length + "    a = sees.own.".length);
  });

  it("has the text's own settings and memory, also over several lines", () => {
    expect(offered("    a = parameters.")?.offers).toEqual([
      { label: "headway", detail: "[s]", info: "Time headway: to the car ahead" },
      { label: "calm", detail: "[1]", info: "Calm" },
    ]);
    expect(offered("    a = memory.")?.offers).toEqual([{ label: "u", detail: "[m/s²]", info: "asked for last" }]);
  });

  it("follows names that stand for parts", () => {
    expect(labels("    p, own = parameters, sees.own\n    a = own.")).toEqual(["speed", "yaw_rate"]);
    expect(labels("    radar = sees.front\n    first = radar.target[0]\n    a = first.")).toEqual(["range", "rate"]);
    expect(labels("    for each in sees.heard.message[:sees.heard.count]:\n        each.payload.")).toEqual(["x", "speed"]);
    expect(labels("    p, own = parameters, sees.own\n    a = p.")).toEqual(["headway", "calm"]);
  });

  it("knows the arguments by whatever name they have", () => {
    expect(labels("    s.own.", HEAD.replace("(parameters, memory, sees)", "(p, m, s)"))).toEqual(["speed", "yaw_rate"]);
  });

  it("offers nothing below a row, below a number, in texts and comments", () => {
    expect(offered("    a = sees.front.target.")).toBeNull();
    expect(offered("    a = sees.own.speed.")).toBeNull();
    expect(offered("    a = 1  # sees.")).toBeNull();
    expect(offered('    a = "sees.')).toBeNull();
    expect(offered("    a = 12.")).toBeNull();
  });

  it("does not go round in circles", () => {
    expect(offered("    a = b\n    b = a\n    c = a.")).toBeNull();
  });

  it("offers sensors and messages where a port names one", () => {
    const line = '    side: Annotated[Targets, "bl';
    const found = complete(line, line.length, VOCABULARY);
    expect(found?.offers.map(({ label }) => label)).toEqual(["front_radar", "blind_spot"]);
    expect(found?.from).toBe(line.length - 2);
  });

  it("offers functions, the contract's names and the text's own", () => {
    const found = offered("    return acc")?.offers ?? [];
    expect(found.find(({ label }) => label === "accelerate")).toEqual({ label: "accelerate", detail: "(acceleration)", info: "Drive and brake" });
    expect(found.map(({ label }) => label)).toEqual(expect.arrayContaining(["sees", "ACCELERATION", "Own"]));
    expect(found.filter(({ label }) => label === "accelerate")).toHaveLength(1);
  });
});
