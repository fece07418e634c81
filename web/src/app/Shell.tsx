/** The frame around every place: head, navigation, theme, keyboard, and notices. */

import {
  ActionIcon,
  Alert,
  Badge,
  Button,
  Kbd,
  Modal,
  Progress,
  Table,
  Tooltip,
  useComputedColorScheme,
  useMantineColorScheme,
} from "@mantine/core";
import { Notifications } from "@mantine/notifications";
import { useQuery } from "@tanstack/react-query";
import { Link, Outlet, useLocation, useMatch, useNavigate } from "@tanstack/react-router";
import { type ReactNode, useEffect, useState } from "react";
import { Unreachable } from "../api/client";
import { heartbeat, kinds, queue, scenarios } from "../api/queries";
import { StudioPage } from "../features/studio/StudioPage";
import { Icon, type IconName } from "../ui/Icon";
import { rememberScenario } from "../ui/memory";
import { useShortcuts } from "../ui/shortcut";
import { openPalette, Palette } from "./Palette";
import { Tour, useTour } from "./Tour";
import classes from "./Shell.module.css";

export function Shell() {
  const [help, setHelp] = useState(false);
  const navigate = useNavigate();
  const studio = useLocation().pathname.startsWith("/studio");
  useShortcuts({
    "?": () => setHelp(true),
    "g s": () => navigate({ to: "/" }),
    "g f": () => navigate({ to: "/scenarios", search: {} }),
    "g r": () => navigate({ to: "/runs", search: {} }),
    "g q": () => navigate({ to: "/queue" }),
    "g c": () => navigate({ to: "/compare", search: {} }),
    "g m": () => navigate({ to: "/maps" }),
    "g k": () => navigate({ to: "/kinds" }),
    "g v": () => navigate({ to: "/validate" }),
  });
  return (
    <div className={classes.shell}>
      <Head onHelp={() => setHelp(true)} />
      <Connection />
      <Compiling />
      <main className={classes.main}>
        <Places />
      </main>
      <Palette onKeys={() => setHelp(true)} />
      <Tour />
      <Keys opened={help} onClose={() => setHelp(false)} />
      <Notifications
        position="bottom-right"
        limit={2}
        className={classes.notices}
        data-studio={studio || undefined}
      />
    </div>
  );
}

interface StudioPlace {
  scenario: string;
  run: number | undefined;
  from: number | undefined;
  time: number | undefined;
  ghosts: string | undefined;
  align: string | undefined;
  camera: string | undefined;
}

/** The studio stays under the other places, so that its scene need not be loaded again. */
function Places() {
  const match = useMatch({ from: "/studio/$scenario", shouldThrow: false });
  const [last, setLast] = useState<StudioPlace>();
  const scenario = match?.params.scenario;
  const { run, from, time, ghosts, align, camera } = match?.search ?? {};
  useEffect(() => {
    if (scenario === undefined) return;
    setLast({ scenario, run, from, time: undefined, ghosts, align, camera: undefined });
    rememberScenario(scenario);
  }, [scenario, run, from, ghosts, align]);
  // A scenario that was deleted or renamed meanwhile is let go.
  const { data: known } = useQuery(scenarios);
  const lost = last !== undefined && known !== undefined && !known.some(({ id }) => id === last.scenario);
  const shown = scenario !== undefined ? { scenario, run, from, time, ghosts, align, camera } : lost ? undefined : last;
  return (
    <>
      {shown ? <StudioPage {...shown} active={scenario !== undefined} /> : null}
      {scenario === undefined ? (
        <div className={classes.place}>
          <Outlet />
        </div>
      ) : null}
    </>
  );
}

function Head({ onHelp }: { onHelp: () => void }) {
  return (
    <header className={classes.head}>
      <Link to="/" className={classes.brand}>
        <img src="/favicon.svg" width="22" height="22" alt="" />
        Cooperative ADAS Studio
      </Link>
      <Navigation />
      <div className={classes.tools}>
        <Tooltip label="Go to anything (Ctrl+K)">
          <ActionIcon variant="subtle" color="gray" aria-label="Go to a place, scenario, run or map" onClick={openPalette}>
            <Icon name="search" size={18} />
          </ActionIcon>
        </Tooltip>
        <ThemeToggle />
        <Tooltip label="Keyboard (?)">
          <ActionIcon variant="subtle" color="gray" aria-label="Show the keyboard shortcuts" onClick={onHelp}>
            <Icon name="help" size={18} />
          </ActionIcon>
        </Tooltip>
      </div>
    </header>
  );
}

function Navigation() {
  const { pathname } = useLocation();
  const broken = useQuery(kinds).data?.broken.length ?? 0;
  const waiting = useQuery(queue).data?.filter(({ status }) => status === "waiting").length ?? 0;
  const place = (to: "/" | "/scenarios" | "/runs" | "/queue" | "/compare" | "/maps" | "/validate" | "/kinds", testId: string, label: ReactNode) => {
    const isEdited = to === "/scenarios" && pathname.startsWith("/edit");
    const here = to === "/" ? pathname === "/" || pathname.startsWith("/studio") : pathname.startsWith(to) || isEdited;
    return (
      <Link
        to={to}
        search={{}}
        className={classes.nav}
        data-testid={testId}
        data-here={here || undefined}
        aria-current={here ? "page" : undefined}
      >
        {label}
      </Link>
    );
  };
  return (
    <nav className={classes.navigation} aria-label="Places">
      {place("/", "nav-studio", "Studio")}
      {place("/scenarios", "nav-scenarios", "Scenarios")}
      {place("/runs", "nav-runs", "Runs")}
      {place("/queue", "nav-queue", <>Queue {waiting > 0 ? <WaitingBadge count={waiting} /> : null}</>)}
      {place("/compare", "nav-compare", "Compare")}
      {place("/maps", "nav-maps", "Maps")}
      {place("/validate", "nav-validate", "Validation")}
      {place("/kinds", "nav-kinds", <>Kinds {broken > 0 ? <BrokenBadge count={broken} /> : null}</>)}
      <a href="/docs/" className={classes.nav} data-testid="nav-docs">
        Docs
      </a>
    </nav>
  );
}

/** Says at every place of the page that files of kinds are broken. */
const BrokenBadge = ({ count }: { count: number }) => (
  <Badge size="xs" color="red" variant="light" tt="none" ml={6}>
    {count} broken
  </Badge>
);

/** Says at every place of the page that runs wait for their turn. */
const WaitingBadge = ({ count }: { count: number }) => (
  <Badge size="xs" color="grape" variant="light" tt="none" ml={6}>
    {count} waiting
  </Badge>
);

const SCHEMES: Record<string, { icon: IconName; label: string }> = {
  auto: { icon: "system", label: "Theme: as the system" },
  light: { icon: "sun", label: "Theme: light" },
  dark: { icon: "moon", label: "Theme: dark" },
};

/** First to the other theme than the one seen, then back, then to the system's. */
function ThemeToggle() {
  const { colorScheme, setColorScheme } = useMantineColorScheme();
  const seen = useComputedColorScheme("light");
  const system = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  const next =
    colorScheme === "auto" ? (seen === "dark" ? "light" : "dark") : seen === system ? "auto" : system;
  const { icon, label } = SCHEMES[colorScheme] ?? { icon: "system" as const, label: "Theme" };
  return (
    <Tooltip label={label}>
      <ActionIcon
        variant="subtle"
        color="gray"
        data-testid="theme-toggle"
        data-scheme={colorScheme}
        aria-label={`${label}. Change to ${next === "auto" ? "the system's" : next}`}
        onClick={() => setColorScheme(next)}
      >
        <Icon name={icon} size={18} />
      </ActionIcon>
    </Tooltip>
  );
}

/** Says that the server is gone, until it is back. */
function Connection() {
  const { error } = useQuery(heartbeat);
  if (!(error instanceof Unreachable)) return null;
  return (
    <Alert
      color="red"
      radius={0}
      py={6}
      icon={<Icon name="unlinked" />}
      role="alert"
      data-testid="connection-lost"
    >
      The studio server does not answer. Trying again … If it was stopped, start it again with{" "}
      <code>uv run studio</code>.
    </Alert>
  );
}

/** Says how far the first compilation on this machine is; a run that is started waits for it. */
function Compiling() {
  const now = useQuery(heartbeat).data?.compiling;
  if (!now) return null;
  return (
    <Alert
      color="blue"
      radius={0}
      py={6}
      icon={<Icon name="compiling" />}
      role="status"
      data-testid="compiling"
    >
      Compiling once for this machine: {now.done} of {now.of} functions, {Math.round(now.seconds)} s
      {now.latest ? <>, the last one {Math.round(now.since)} s ago: {now.latest}</> : null}. Large functions take minutes each, and several are
      compiled at a time. A run that is started waits for it.
      <Progress mt={4} size="xs" value={(100 * now.done) / now.of} aria-label="Functions that are compiled" />
    </Alert>
  );
}

const KEYS: [string[], string][] = [
  [["space"], "Run, pause or resume; play or pause a run that is over"],
  [["r"], "Run, or run again"],
  [["."], "Step one tick (20 ms); of a run that is over, one sample on"],
  [[","], "One sample back in a run that is over"],
  [["<", ">"], "One second back or on in a run that is over"],
  [["[", "]"], "Previous or next event of a run that is over"],
  [["i", "o"], "The stretch of a run that is over begins, or ends, here"],
  [["/"], "Search parameters, scenarios or kinds, or filter the runs"],
  [["g", "s"], "Go to the studio"],
  [["g", "f"], "Go to the scenario files"],
  [["g", "r"], "Go to the runs"],
  [["g", "q"], "Go to the queue"],
  [["g", "c"], "Go to the comparison"],
  [["g", "m"], "Go to the maps"],
  [["g", "k"], "Go to the kinds"],
  [["↑", "↓", "j", "k"], "Move between rows of the runs or of the queue"],
  [["x"], "Select a row to compare"],
  [["X"], "Compare the rows that are selected"],
  [["p"], "Pin the run of the row on top, or the column of the head at the left, or let it go"],
  [["b"], "Tint the metrics of the runs against that of the row"],
  [["c", "d"], "Make a run a candidate, or discard it, with a reason"],
  [["enter"], "Open the run of a row"],
  [["n"], "New scenario, among the scenarios"],
  [["F2"], "Rename the scenario of a row"],
  [["del"], "Delete the scenario of a row; it can be brought back"],
  [["ctrl", "S"], "Save the text of a scenario"],
  [["ctrl", "Z"], "Undo the last step in the editor; with Shift, do it again"],
  [["ctrl", "C"], "Copy what is chosen in the editor; Ctrl+V puts it down, Ctrl+D does both, Ctrl+A chooses everything"],
  [["del"], "Delete what is chosen in the editor"],
  [["arrows"], "Move what is chosen in the editor by half a metre; with Shift by five"],
  [["f"], "Look at what is chosen in the editor, or at everything"],
  [["m"], "Measure in the editor"],
  [["r"], "Lead the route of what is chosen in the editor along the roads that are clicked"],
  [["n"], "Names on the plan of the editor"],
  [["esc"], "Take the last point back, leave a tool, choose nothing"],
  [["+", "−"], "Enlarge or reduce the plan of a map"],
  [["f"], "Show all of the plan"],
  [["ctrl", "K"], "Go to any place, scenario, run or map by its name"],
  [["?"], "Show this"],
];

function Keys({ opened, onClose }: { opened: boolean; onClose: () => void }) {
  const { begin } = useTour();
  const navigate = useNavigate();
  const tour = () => {
    onClose();
    begin();
    void navigate({ to: "/" });
  };
  return (
    <Modal opened={opened} onClose={onClose} title="Keyboard" size="sm">
      <Button size="xs" variant="light" mb="xs" onClick={tour}>
        Take the tour of ninety seconds
      </Button>
      <Table verticalSpacing={5}>
        <Table.Tbody>
          {KEYS.map(([keys, what]) => (
            <Table.Tr key={what}>
              <Table.Td w={110}>
                {keys.map((key) => (
                  <Kbd key={key} mr={4}>
                    {key}
                  </Kbd>
                ))}
              </Table.Td>
              <Table.Td>{what}</Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </Modal>
  );
}
