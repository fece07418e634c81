/** Messages between the page and the 3D scene in its frame. */

import { type RefObject, useCallback, useEffect, useState } from "react";

export type View = "overview" | "top" | "chase" | "driver";

export type Command =
  | { studio: "follow"; vehicle: number | null }
  | { studio: "view"; preset: View }
  | { studio: "theme"; dark: boolean };

interface Bridge {
  /** Counts how often the scene said that it is ready; 0 until the first time. */
  ready: number;
  send: (command: Command) => void;
}

/** Talk to the scene; only messages of our own frame and origin are believed. Its keys count as the page's. */
export function useBridge(
  frame: RefObject<HTMLIFrameElement | null>,
  onPicked: (vehicle: number) => void,
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
  const send = useCallback(
    (command: Command) => frame.current?.contentWindow?.postMessage(command, location.origin),
    [frame],
  );
  return { ready, send };
}
