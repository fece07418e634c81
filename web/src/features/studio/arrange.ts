/** The charts of a scenario, as somebody has arranged them in this browser. */

import { useLocalStorage } from "@mantine/hooks";
import { useMemo } from "react";
import { type Layout, layoutOf } from "../../model/layout";
import type { Json } from "../../model/run";
import { chartsKey } from "../../ui/memory";

export function useLayout(scenario: string): [Layout, (layout: Layout) => void] {
  const [kept, keep] = useLocalStorage<Layout | null>({ key: chartsKey(scenario), defaultValue: null, getInitialValueInEffect: false });
  const layout = useMemo(() => layoutOf(kept as Json), [kept]);
  return [layout, keep];
}
