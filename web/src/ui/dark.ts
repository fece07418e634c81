import { useComputedColorScheme } from "@mantine/core";

/** Whether the page is dark now, whatever the reason. */
export const useDark = (): boolean => useComputedColorScheme("light") === "dark";
