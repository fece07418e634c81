/** The 3D scene in its frame, with the controls that belong to looking. */

import { ActionIcon, NativeSelect, SegmentedControl, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { memo, useCallback, useEffect, useRef, useState } from "react";
import { scenePlace } from "../../api/stage";
import type { Scene, SceneVehicle } from "../../api/types";
import { type Camera, cameraOf, cameraText } from "../../model/camera";
import { isTraffic } from "../../model/channel";
import { formatDifference, words } from "../../model/units";
import { useDark } from "../../ui/dark";
import { Icon } from "../../ui/Icon";
import { cameraIn, useBridge, useMap, type View } from "../../api/bridge";
import { LayersMenu } from "./LayersMenu";
import { type Sight, useLayers } from "./sight";
import classes from "./Studio.module.css";

const VIEWS = [
  { value: "overview", label: "Overview" },
  { value: "top", label: "Top" },
  { value: "chase", label: "Chase" },
  { value: "driver", label: "Driver" },
];

interface Props {
  vehicles: readonly SceneVehicle[];
  attribution: string;
  /** False while another page covers the scene: the frame stays, its controls go. */
  active: boolean;
  /** Whether a run is going on: then the first car is followed, unless somebody has chosen a view. */
  running: boolean;
  /** What the scene is to show; why it does not yet, empty when it does; and the map of it. */
  title: string;
  waits: string;
  map: string | undefined;
  /** Other runs that are among the cars. */
  ghosts: Scene["ghosts"];
  /** Whether what is shown is a run, live or played back. */
  run: boolean;
  /** What is drawn over the scene, and which layers of it cannot be. */
  sight: Sight;
  missing: Readonly<Record<string, string>>;
  /** How a link wants it to be looked at; and the address of what is shown, to be completed with how it is looked at now. */
  camera: string | undefined;
  onLink: (camera: string) => void;
  /** The scene has lost what it showed, as after a restart of the server. */
  onEmptied: () => void;
}

export const SceneView = memo(function SceneView({ vehicles, attribution, active, running, title, waits, map, ghosts, run, sight, missing, camera, onLink, onEmptied }: Props) {
  const frame = useRef<HTMLIFrameElement>(null);
  const dark = useDark();
  const [followed, setFollowed] = useState<number | null>(null);
  const [view, setView] = useState<View>("overview");
  const chosen = useRef(false);
  const told = useRef<View>("overview");
  const follow = useCallback((vehicle: number | null) => {
    chosen.current = true;
    setFollowed(vehicle);
    setView((before) => (vehicle === null ? "overview" : before === "overview" ? "chase" : before));
  }, []);
  const place = useQuery(scenePlace);
  const there = useMap(frame, map ?? "");
  const { ready, send } = useBridge(frame, follow, onEmptied);

  // A scene that has just become ready must be told everything again.
  // `ready` counts how often that was.
  useEffect(() => send({ studio: "theme", dark }), [dark, ready, send]);
  const [layers, chooseLayers] = useLayers();
  useEffect(() => send({ studio: "rest", rest: !active }), [active, ready, send]);
  useEffect(() => send({ studio: "layers", on: layers }), [layers, ready, send]);
  useEffect(() => {
    send({ studio: "cast", cars: vehicles });
    return sight.show((seen) => send({ studio: "seen", layers: seen }));
  }, [vehicles, sight, ready, send]);
  useEffect(() => {
    // Nothing was chosen for a scene that is built again, and the user may have turned it.
    if (followed === null && view === "overview" && told.current === view) return;
    told.current = view;
    send({ studio: "follow", vehicle: followed });
    send({ studio: "view", preset: view });
  }, [followed, view, ready, send]);
  useCamera(camera, vehicles, ready, (wanted, vehicle) => {
    chosen.current = true;
    setFollowed(vehicle);
    setView(wanted.view === "free" ? "overview" : wanted.view);
    told.current = "overview";
    if (vehicle === null) send({ studio: "follow", vehicle });
    send({ studio: "camera", camera: wanted });
  });
  const link = () => {
    const now = cameraIn(frame.current);
    const vehicle = now?.at ? "" : (vehicles.find(({ index }) => index === followed)?.name ?? "");
    if (now) onLink(cameraText({ ...now, vehicle, view: vehicle === "" ? "free" : view === "overview" ? "chase" : view }));
  };
  const first = vehicles[0]?.index;
  useEffect(() => {
    if (!running || chosen.current || first === undefined) return;
    setFollowed(first);
    setView("chase");
  }, [running, first]);
  const choose = (preset: View) => {
    chosen.current = true;
    setView(preset);
    if (preset === "overview") setFollowed(null);
    if (preset === "chase" || preset === "driver") setFollowed(followed ?? vehicles[0]?.index ?? null);
  };

  return (
    <div className={classes.scene}>
      {place.data ? <iframe ref={frame} title="3D scene" src={place.data} data-testid="scene-frame" className={classes.frame} /> : null}
      {active ? (
        <div className={classes.look}>
          <NativeSelect
            size="xs"
            aria-label="Follow a car"
            data-testid="follow"
            value={followed ?? ""}
            onChange={({ currentTarget: { value } }) => follow(value === "" ? null : Number(value))}
            data={followChoices(vehicles)}
          />
          <SegmentedControl
            size="xs"
            transitionDuration={0}
            aria-label="View"
            data={VIEWS}
            value={view}
            onChange={(value) => choose(value as View)}
          />
          <Tooltip label="Copy a link to this view">
            <ActionIcon size={30} variant="default" aria-label="Copy a link to this view" onClick={link}>
              <Icon name="link" size={14} />
            </ActionIcon>
          </Tooltip>
          <LayersMenu on={layers} onChange={chooseLayers} running={run} missing={ghosts?.length ? missing : { ...missing, ghosts: "no other run is among these cars" }} />
        </div>
      ) : null}
      {waits || !there ? <Cover key={title} title={title} what={place.error?.message || waits || (ready ? "The browser loads the map" : "The 3D view comes up")} /> : null}
      {active && ghosts?.length ? <Ghosts ghosts={ghosts} /> : null}
      <span className={classes.attribution} data-testid="attribution" hidden={attribution === ""}>
        {attribution}
      </span>
    </div>
  );
});

/** A link may say how it is looked at: once its scene is up, and the car that it follows is there, that is so; then one looks as one likes. */
function useCamera(text: string | undefined, vehicles: readonly SceneVehicle[], ready: number, look: (wanted: Camera, vehicle: number | null) => void) {
  const [wanted, setWanted] = useState(() => cameraOf(text));
  useEffect(() => setWanted((before) => cameraOf(text) ?? before), [text]);
  const latest = useRef(look);
  latest.current = look;
  useEffect(() => {
    if (!wanted || ready === 0 || vehicles.length === 0) return;
    const followed = vehicles.find(({ name }) => name === wanted.vehicle);
    if (followed || !wanted.vehicle) latest.current(wanted, followed?.index ?? null);
    setWanted(undefined);
  }, [wanted, ready, vehicles]);
}

/** Over the scene while that is not what the title says: what is going on, and for how long. */
function Cover({ title, what }: { title: string; what: string }) {
  const [seconds, setSeconds] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => setSeconds((before) => before + 1), 1000);
    return () => clearInterval(timer);
  }, []);
  return (
    <div className={classes.cover} role="status" aria-label="The scene is loading">
      <b>{title}</b>
      <span>
        {what} … {seconds > 1 ? <span aria-hidden="true">{seconds} s</span> : null}
      </span>
    </div>
  );
}

/** Which colour is whose run. */
function Ghosts({ ghosts }: { ghosts: NonNullable<Scene["ghosts"]> }) {
  return (
    <ul className={classes.ghosts} aria-label="Ghosts of other runs">
      {ghosts.map(({ run, color, offset }) => (
        <li key={run}>
          <span className={classes.ghost} style={{ background: color }} /> #{run}
          {offset ? `, its clock ${formatDifference(Number(offset.toFixed(2)))} s` : ""}
        </li>
      ))}
    </ul>
  );
}

/** The platoon first, the surrounding traffic in a group of its own. */
function followChoices(vehicles: readonly SceneVehicle[]) {
  const items = (some: readonly SceneVehicle[]) =>
    some.map(({ name, index }) => ({ value: String(index), label: words(name) }));
  const platoon = vehicles.filter(({ name }) => !isTraffic(name));
  const traffic = vehicles.filter(({ name }) => isTraffic(name));
  return [
    { value: "", label: "Follow no car" },
    ...items(platoon),
    ...(traffic.length ? [{ group: "Traffic", items: items(traffic) }] : []),
  ];
}
