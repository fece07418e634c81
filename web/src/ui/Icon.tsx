/** The few icons of the page, drawn on a grid of 24. */

const PATHS = {
  run: "M7 5l12 7-12 7z",
  pause: "M8 5v14M16 5v14",
  step: "M6 5l8 7-8 7zM18 5v14",
  back: "M18 5l-8 7 8 7zM6 5v14",
  stop: "M6 6h12v12H6z",
  sun: "M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M19 5l-2 2M7 17l-2 2",
  moon: "M20 14A8 8 0 0 1 10 4a8 8 0 1 0 10 10z",
  system: "M3 5h18v11H3zM9 20h6M12 16v4",
  search: "M11 4a7 7 0 1 0 0 14 7 7 0 0 0 0-14zM16 16l5 5",
  reset: "M4 5v5h5M4.5 10A8 8 0 1 1 4 14",
  swap: "M4 8h15l-4-4M20 16H5l4 4",
  help: "M9 9a3 3 0 1 1 4 3c-1 .5-1 1-1 2M12 18v.5",
  warning: "M12 4l9 16H3zM12 10v5M12 17.5v.5",
  chart: "M4 4v16h16M7 15l4-5 3 3 5-7",
  table: "M4 5h16v14H4zM4 10h16M4 14.5h16M10 5v14",
  compare: "M4 20V9h4v11zM16 20V4h4v16zM10 20v-7h4v7z",
  car: "M4 16v-4l2-5h12l2 5v4zM4 12h16M7 16v2M17 16v2",
  up: "M6 14l6-6 6 6",
  down: "M6 10l6 6 6-6",
  left: "M14 6l-6 6 6 6",
  right: "M10 6l6 6-6 6",
  close: "M6 6l12 12M18 6L6 18",
  check: "M5 13l4 4L19 7",
  branch: "M6 4v16M6 14c8 0 12-2 12-9M15 7l3-3 3 3",
  columns: "M4 5h16v14H4zM9.5 5v14M14.5 5v14",
  compiling: "M6 3h12M6 21h12M7 3c0 6 10 12 10 18M17 3c0 6-10 12-10 18",
  link: "M9.5 14.5l5-5M10.5 7l2-2a4.2 4.2 0 0 1 6 6l-2 2M13.5 17l-2 2a4.2 4.2 0 0 1-6-6l2-2",
  unlinked: "M9 15l-3 3a3 3 0 0 1-4-4l3-3M15 9l3-3a3 3 0 0 1 4 4l-3 3M4 4l16 16",
  upload: "M12 16V5M7 9.5L12 4.5l5 5M4 16v4h16v-4",
  map: "M9 5L3 7.5v12L9 17l6 2.5 6-2.5V5l-6 2.5zM9 5v12M15 7.5v12",
  trash: "M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13M10.5 10.5v6M13.5 10.5v6",
  plus: "M12 5v14M5 12h14",
  minus: "M5 12h14",
  fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  undo: "M9 6L4 11l5 5M4 11h9a6 6 0 0 1 6 6v2",
  more: "M4.5 12h1M11.5 12h1M18.5 12h1",
  pen: "M4 20l1-5L16 4l4 4L9 19zM14 6l4 4",
  copy: "M9 9h11v11H9zM5 15H4V4h11v1",
  download: "M12 4v11M7 10.5l5 5 5-5M4 17v3h16v-3",
  text: "M5 4h14v16H5zM8 9h8M8 12.5h8M8 16h5",
  save: "M4 4h13l3 3v13H4zM8 4v5h7V4M8 20v-6h8v6",
  lock: "M6 11h12v9H6zM8.5 11V8a3.5 3.5 0 0 1 7 0v3",
  redo: "M15 6l5 5-5 5M20 11h-9a6 6 0 0 0-6 6v2",
  tape: "M4 16L16 4l4 4L8 20zM8 12l2 2M11 9l2 2M14 6l2 2",
  route: "M6 20a2 2 0 1 0 0-4 2 2 0 0 0 0 4zM18 8a2 2 0 1 0 0-4 2 2 0 0 0 0 4zM8 18h7a3 3 0 0 0 0-6H9a3 3 0 0 1 0-6h7",
  pin: "M9 4h6M10 4v6l-4 4h12l-4-4V4M12 14v6",
  eye: "M2 12c5-8 15-8 20 0-5 8-15 8-20 0zM12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6z",
} as const;

export type IconName = keyof typeof PATHS;

const FILLED: ReadonlySet<IconName> = new Set<IconName>(["run", "stop"]);

/** A decorative icon in the colour of the text around it; the control that holds it has the label. */
export function Icon({ name, size = 16 }: { name: IconName; size?: number }) {
  return (
    <svg
      width={size}
      height={size}
      viewBox="0 0 24 24"
      fill={FILLED.has(name) ? "currentColor" : "none"}
      stroke="currentColor"
      strokeWidth="2"
      strokeLinecap="round"
      strokeLinejoin="round"
      aria-hidden="true"
    >
      <path d={PATHS[name]} />
    </svg>
  );
}
