/** The socket of a live run, kept open as long as somebody looks at it. */

import { useEffect, useState, useSyncExternalStore } from "react";
import type { Layers } from "../model/layer";
import { type Channel, isLive, type RunEvent, type Server } from "../model/run";
import { append, noSamples, type Samples } from "../model/samples";

export interface LiveState extends Omit<Server["StateNews"], "type" | "scenario"> {
  error: string | null;
  /** False while the socket is being opened again. */
  connected: boolean;
  events: RunEvent[];
  /** What the samples are of. */
  channels: Channel[];
  /** Grows in place; `version` tells when. */
  samples: Samples;
  version: number;
  /** What can be drawn over the scene now. */
  layers: Layers | null;
}

const RETRY_MS = 1500;
/** Messages that come this close together are told to the readers at once. */
const QUIET_MS = 40;

const fresh = (run: number): LiveState => ({
  run,
  status: "starting",
  time: 0,
  duration_s: 0,
  pace: 1,
  real_time_factor: 0,
  position: 0,
  error: null,
  connected: true,
  events: [],
  channels: [],
  samples: noSamples(),
  version: 0,
  layers: null,
});

/** What one message makes of the state. */
export function reduce(state: LiveState, message: Server["News"]): LiveState {
  switch (message.type) {
    case "state": {
      const { type: _type, scenario: _scenario, ...values } = message;
      return { ...state, ...values };
    }
    case "channels":
      return { ...state, channels: message.channels };
    case "samples":
      append(state.samples, message);
      return { ...state, version: state.version + 1 };
    case "layers":
      return { ...state, layers: message };
    case "event": {
      const { type: _type, ...event } = message;
      // a near miss is told when it is over, and stands where it was
      const place = state.events.findLastIndex((each) => each.time <= event.time) + 1;
      return { ...state, events: state.events.toSpliced(place, 0, event) };
    }
    case "end":
      return { ...state, status: message.status, error: message.error, real_time_factor: 0, position: 0 };
    case "refused":
      // The server knows no such live run, after a restart perhaps: there is nothing to wait for.
      return { ...state, status: "failed", error: message.message, real_time_factor: 0 };
    default:
      return state;
  }
}

/** A live run as an external store: one socket, many readers. */
export class Feed {
  private state: LiveState;
  private told: LiveState;
  private listeners = new Set<() => void>();
  private socket: WebSocket | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private closed = false;
  private telling: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly run: number) {
    this.state = fresh(run);
    this.told = this.state;
  }

  /** What was told last; it stays the same between two calls of the readers. */
  read = (): LiveState => this.told;

  subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  open(): void {
    this.closed = false;
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/api/live/${this.run}/socket`);
    this.socket = socket;
    // A new socket gets all samples so far, so the old ones must go.
    socket.onopen = () =>
      this.set({ ...fresh(this.run), status: this.state.status, version: this.state.version + 1 });
    socket.onmessage = ({ data }) => this.set(reduce(this.state, JSON.parse(data) as Server["News"]));
    socket.onclose = () => this.lost();
  }

  close(): void {
    this.closed = true;
    clearTimeout(this.timer);
    clearTimeout(this.telling);
    this.socket?.close();
  }

  private lost(): void {
    if (this.closed || !isLive(this.state.status)) return;
    this.set({ ...this.state, connected: false });
    this.timer = setTimeout(() => this.open(), RETRY_MS);
  }

  private set(state: LiveState): void {
    this.state = state;
    this.telling ??= setTimeout(() => this.tell(), QUIET_MS);
  }

  private tell(): void {
    this.telling = undefined;
    this.told = this.state;
    for (const listener of this.listeners) listener();
  }
}

const nothing = () => () => {};

/** The live state of a run, or undefined when there is none to follow. */
export function useLive(run: number | undefined): LiveState | undefined {
  const [feed, setFeed] = useState<Feed>();
  useEffect(() => {
    if (run === undefined) return setFeed(undefined);
    const opened = new Feed(run);
    opened.open();
    setFeed(opened);
    return () => opened.close();
  }, [run]);
  const state = useSyncExternalStore(feed?.subscribe ?? nothing, () => feed?.read());
  return state?.run === run ? state : undefined;
}
