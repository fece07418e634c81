import { type CSSVariablesResolver, createTheme, Tooltip } from "@mantine/core";

/** Compact and plain: an engineering tool shows much at once. */
export const theme = createTheme({
  primaryColor: "blue",
  primaryShade: { light: 8, dark: 8 },
  defaultRadius: "sm",
  cursorType: "pointer",
  autoContrast: true,
  fontFamily: 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif',
  fontFamilyMonospace: 'ui-monospace, SFMono-Regular, Menlo, Consolas, "DejaVu Sans Mono", monospace',
  respectReducedMotion: true,
  components: {
    Tooltip: Tooltip.extend({
      defaultProps: { withArrow: true, openDelay: 300, events: { hover: true, focus: true, touch: false } },
    }),
  },
});

/** Of badges and notes on their light grounds: the library's own shades are a little too pale to read. */
const TEXT_ON_LIGHT = {
  blue: "#12508a",
  grape: "#74208c",
  gray: "#343a40",
  orange: "#8f3500",
  red: "#9c1c1c",
  teal: "#05573d",
  yellow: "#7a4100",
};

/** Text has a contrast of at least 4.5:1 to what is behind it (WCAG 2.2, 1.4.3), on tinted rows too. */
export const legible: CSSVariablesResolver = () => ({
  variables: {},
  light: {
    "--mantine-color-dimmed": "#575e6b",
    "--mantine-color-placeholder": "#5f6673",
    "--mantine-color-anchor": "#155a9e",
    "--mantine-color-error": "#b62222",
    "--mantine-color-red-outline": "#b62222",
    ...Object.fromEntries(Object.entries(TEXT_ON_LIGHT).map(([name, colour]) => [`--mantine-color-${name}-light-color`, colour])),
  },
  dark: {
    "--mantine-color-dimmed": "#a6a7ab",
    "--mantine-color-placeholder": "#9a9b9f",
    "--mantine-color-error": "#ff8787",
  },
});
