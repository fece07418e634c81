import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { answer, client, Refusal, Unreachable } from "./client";
import { Feed, type LiveState, reduce } from "./live";

afterEach(() => vi.unstubAllGlobals());
const stub = (status: number, body: unknown) =>
  vi.stubGlobal(
    "fetch",
    vi.fn(async () => new Response(JSON.stringify(body), { status })),
  );

const info = () => answer<unknown>(client.GET("/api/info"));
const start = () =>
  answer<unknown>(client.POST("/api/live", { body: { scenario: "a", set: {}, pace: 1, paused: false } }));

describe("requests", () => {
  it("give back what the server says", async () => {
    stub(200, { version: "1" });
    expect(await info()).toEqual({ version: "1" });
  });

  it("send JSON", async () => {
    stub(201, { run: 3 });
    await start();
    const sent = vi.mocked(fetch).mock.lastCall?.[0] as Request;
    expect([sent.method, new URL(sent.url).pathname, (await sent.json()).scenario]).toEqual([
      "POST",
      "/api/live",
      "a",
    ]);
  });

  it("fail with the message and problems of a refusal", async () => {
    const problem = { where: "radio.delay", what: "is too large", value: "7", allowed: "", remedy: "" };
    stub(422, { message: "No.", problems: [problem] });
    const error = await start().catch((caught) => caught);
    expect(error).toBeInstanceOf(Refusal);
    expect(error).toMatchObject({ message: "No.", problems: [problem], status: 422 });
  });

  it("tell by the status what has no message", async () => {
    stub(500, "oops");
    expect(await info().catch((caught) => caught.message)).toBe("The server answered 500.");
  });

  it("tell a server that is gone, also behind a proxy", async () => {
    vi.stubGlobal(
      "fetch",
      vi.fn(async () => Promise.reject(new TypeError("network"))),
    );
    expect(await info().catch((caught) => caught)).toBeInstanceOf(Unreachable);
    stub(502, "bad gateway");
    expect(await info().catch((caught) => caught)).toBeInstanceOf(Unreachable);
  });
});

/** A socket that is opened, fed and closed by the test. */
class FakeSocket {
  static all: FakeSocket[] = [];
  onopen?: () => void;
  onmessage?: (event: { data: string }) => void;
  onclose?: () => void;
  constructor(readonly url: string) {
    FakeSocket.all.push(this);
  }
  close() {
    this.onclose?.();
  }
  say(message: unknown) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
}

const state = (status: string, time = 1) => ({
  type: "state",
  run: 5,
  scenario: "test",
  status,
  time,
  duration_s: 60,
  pace: 1,
  real_time_factor: 0.9,
});

describe("the feed of a live run", () => {
  const opened = (): [Feed, FakeSocket] => {
    FakeSocket.all = [];
    vi.stubGlobal("WebSocket", FakeSocket);
    const feed = new Feed(5);
    feed.open();
    const socket = FakeSocket.all[0] as FakeSocket;
    socket.onopen?.();
    return [feed, socket];
  };

  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());
  const told = (feed: Feed) => {
    vi.advanceTimersByTime(50);
    return feed.read();
  };

  it("gathers state, samples and events, and tells its readers once", () => {
    const [feed, socket] = opened();
    const listener = vi.fn();
    feed.subscribe(listener);
    socket.say(state("running"));
    const channels = [{ name: "leader.front.range", unit: "m", label: "Range of front" }];
    socket.say({ type: "channels", channels });
    socket.say({ type: "samples", time: [0, 0.02], channels: { "leader.speed": [1, 2] } });
    const brakes = { time: 0.5, text: "brakes", vehicle: "leader", kind: "script_begun", units: ["leader"], x: 1, y: 2, numbers: {} };
    socket.say({ type: "event", ...brakes });
    expect(socket.url).toMatch(/^ws:.*\/api\/live\/5\/socket$/);
    expect(told(feed)).toMatchObject({
      status: "running",
      time: 1,
      real_time_factor: 0.9,
      channels,
      samples: { time: [0, 0.02] },
      events: [brakes],
    });
    expect(listener).toHaveBeenCalledTimes(1);
  });

  it("puts an event that is told late to its time", () => {
    const [feed, socket] = opened();
    const event = { vehicle: "", units: [], x: null, y: null, numbers: {} };
    for (const [time, kind] of [[1, "collision"], [4, "arrived"], [2, "near_miss"], [4, "script_ended"]] as const)
      socket.say({ type: "event", ...event, time, kind, text: kind });
    expect(told(feed).events.map(({ kind }) => kind)).toEqual(["collision", "near_miss", "arrived", "script_ended"]);
  });

  it("says that it is cut off, opens again, and forgets what will be sent again", () => {
    const [feed, socket] = opened();
    socket.say(state("running"));
    socket.say({ type: "samples", time: [0], channels: { a: [1] } });
    socket.close();
    expect(told(feed).connected).toBe(false);
    vi.advanceTimersByTime(2000);
    const again = FakeSocket.all[1] as FakeSocket;
    again.onopen?.();
    expect(told(feed)).toMatchObject({ connected: true, status: "running", samples: { time: [] } });
    feed.close();
    vi.advanceTimersByTime(5000);
    expect(FakeSocket.all).toHaveLength(2);
  });

  it("does not open again after the end", () => {
    const [feed, socket] = opened();
    socket.say({ type: "end", run: 5, status: "failed", error: "Traceback" });
    socket.close();
    vi.advanceTimersByTime(5000);
    expect(told(feed)).toMatchObject({ status: "failed", error: "Traceback", connected: true });
    expect(FakeSocket.all).toHaveLength(1);
  });

  it("ignores a message that it does not know", () => {
    const before = { status: "running" } as LiveState;
    const refused = reduce(before, { type: "refused", message: "Run 9 is not a live run of this server.", problems: [] });
    expect(refused).toMatchObject({ status: "failed", error: "Run 9 is not a live run of this server." });
    expect(reduce(before, { type: "later" } as never)).toBe(before);
  });
});
