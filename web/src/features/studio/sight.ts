/** What is drawn over the scene: which layers, and the newest of what they are made of. It goes to the scene past React, many times a second. */

import { useLocalStorage } from "@mantine/hooks";
import { useEffect, useState } from "react";
import type { LiveState } from "../../api/live";
import { type Layers, USUAL } from "../../model/layer";

export class Sight {
  layers: Layers | null = null;
  private listener: (layers: Layers | null) => void = () => undefined;

  /** Who draws it; what there is comes at once. */
  readonly show = (draw: (layers: Layers | null) => void): (() => void) => {
    this.listener = draw;
    draw(this.layers);
    return () => {
      this.listener = () => undefined;
    };
  };

  readonly put = (layers: Layers | null): void => {
    if (layers === this.layers) return;
    this.layers = layers;
    this.listener(layers);
  };
}

/** The sight of the scene: it follows a live run; who plays one back puts in what belongs to the time. `what` is what is shown at all. */
export function useSight(live: LiveState | undefined, what: unknown): Sight {
  const [sight] = useState(() => new Sight());
  useEffect(() => sight.put(null), [sight, what]);
  const layers = live?.layers;
  useEffect(() => {
    if (layers) sight.put(layers);
  }, [sight, layers]);
  return sight;
}

/** The layers that are on, as somebody has left them. */
export const useLayers = () => useLocalStorage<readonly string[]>({ key: "layers", defaultValue: USUAL, getInitialValueInEffect: false });
