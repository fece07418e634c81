/** Messages between the page and the 3D scene in its frame. */

import { type RefObject, useCallback, useEffect, useState } from "react";
import type { SceneVehicle } from "./types";
import type { Camera } from "../model/camera";
import type { Marks } from "../model/editing/mark";
import type { Layers } from "../model/layer";

export type View = "overview" | "top" | "chase" | "driver";

export type Command =
  | { studio: "cast"; cars: readonly SceneVehicle[] }
  | { studio: "layers"; on: readonly string[] }
  | { studio: "seen"; layers: Layers | null }
  | { studio: "rest"; rest: boolean }
  | { studio: "follow"; vehicle: number | null }
  | { studio: "view"; preset: View }
  | { studio: "camera"; camera: Omit<Camera, "view" | "vehicle"> }
  | { studio: "marks"; marks: Marks }
  | { studio: "theme"; dark: boolean };

interface Bridge {
  /** Counts how often the scene came up or was built again; 0 until the first time. */
  ready: number;
  send: (command: Command) => void;
}

/** Talk to the scene; only messages of our own frame and origin are believed. Its keys count as the page's. */
export function useBridge(
  frame: RefObject<HTMLIFrameElement | null>,
  onPicked: (vehicle: number) => void,
  onEmptied: () => void,
): Bridge {
  const [ready, setReady] = useState(0);
  useEffect(() => {
    const listen = ({ origin, source, data }: MessageEvent) => {
      if (origin !== location.origin || source !== frame.current?.contentWindow) return;
      if (data?.studio === "ready") setReady((count) => count + 1);
      if (data?.studio === "key")
        window.dispatchEvent(new KeyboardEvent("keydown", { ...data, bubbles: true }));
      if (data?.studio === "picked" && typeof data.vehicle === "number") onPicked(data.vehicle);
    };
    window.addEventListener("message", listen);
    return () => window.removeEventListener("message", listen);
  }, [frame, onPicked]);
  useEffect(() => {
    const watched = new Rebuilding(() => partsOf(frame.current));
    const timer = setInterval(() => {
      const seen = watched.look();
      if (seen === "rebuilt") setReady((count) => count + 1);
      if (seen === "emptied") onEmptied();
    }, LOOK_MS);
    return () => clearInterval(timer);
  }, [frame, onEmptied]);
  const send = useCallback(
    (command: Command) => frame.current?.contentWindow?.postMessage(command, location.origin),
    [frame],
  );
  return { ready, send };
}

/** How often the page looks whether the scene was built again [ms]; the bridge does not tell. */
const LOOK_MS = 1000;

interface SceneFrame extends Window {
  __studioBridge?: { camera?: () => Omit<Camera, "view" | "vehicle"> | null; client: () => { nodeRefFromName?: Record<string, unknown> } | undefined };
}

/** How the scene is looked at now; nothing while it is not up. */
export const cameraIn = (frame: HTMLIFrameElement | null) => (frame?.contentWindow as SceneFrame | null)?.__studioBridge?.camera?.() ?? undefined;

/** What only a new connection or a new city replaces, and what is only there when something is shown. */
function partsOf(frame: HTMLIFrameElement | null): Parts {
  const nodes = (frame?.contentWindow as SceneFrame | null)?.__studioBridge?.client()?.nodeRefFromName;
  return { road: nodes?.["/city/road"], vehicles: nodes?.["/vehicles/shadows"] };
}

interface Parts {
  road: unknown;
  vehicles: unknown;
}

/** Notices that the scene was built again, or that nothing is left in it. */
export class Rebuilding {
  private road: unknown;
  private missing = 0;
  private settling = 0;

  constructor(private readonly parts: () => Parts) {}

  look(): "rebuilt" | "emptied" | "same" {
    const { road, vehicles } = this.parts();
    if (!road || !vehicles) {
      // A scene that has never shown anything is still coming up.
      if (this.road === undefined) return "same";
      this.missing += 1;
      return this.missing % PATIENCE === 0 ? "emptied" : "same";
    }
    if (this.road !== undefined && (road !== this.road || this.missing > 0)) this.settling = 2;
    this.road = road;
    this.missing = 0;
    // Lights and haze come a moment after the road, and the bridge turns to the overview for a new city.
    this.settling -= 1;
    return this.settling === 0 ? "rebuilt" : "same";
  }
}

/** So many looks without anything there mean that the server has forgotten what it showed. */
export const PATIENCE = 8;

/** [ms] Between two looks whether the scene has a map. */
const GLANCE_MS = 150;

/** Whether the scene has all of a map, as the server names it. */
export function useMap(frame: RefObject<HTMLIFrameElement | null>, map: string): boolean {
  const [there, found] = useState("");
  useEffect(() => {
    if (there === map) return;
    const look = () => {
      if (nodesOf(frame.current)[`/map/${map}`]) found(map);
    };
    const timer = setInterval(look, GLANCE_MS);
    return () => clearInterval(timer);
  }, [frame, map, there]);
  return map !== "" && there === map;
}

interface Tree extends Window {
  __viserSceneTree?: { getState: () => Record<string, unknown> };
}

const nodesOf = (frame: HTMLIFrameElement | null): Record<string, unknown> =>
  (frame?.contentWindow as Tree | null)?.__viserSceneTree?.getState() ?? {};
