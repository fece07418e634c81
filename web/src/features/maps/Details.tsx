/** What is selected on the plan or in the table: a finding or a road, and what can be corrected of it. */

import { ActionIcon, Anchor, Button, NativeSelect, Text, Tooltip } from "@mantine/core";
import { type ReactNode, useState } from "react";
import { useTakeBack } from "../../api/maps";
import { ALL_PARTS, lanesOf, wayElement } from "../../model/correction";
import { changeText, type Finding, MARK_NAMES } from "../../model/finding";
import type { Correction, Plan, PlanRoad } from "../../model/map";
import { words } from "../../model/units";
import { Icon } from "../../ui/Icon";
import { notifyError } from "../../ui/notify";
import { FindingEditor, WayEditor } from "./Editor";
import classes from "./Maps.module.css";
import { MarkIcon } from "./MarkIcon";

interface Shared {
  map: string;
  plan: Plan;
  corrections: readonly Correction[];
  /** Which import this is: the forms of another one begin anew. */
  digest: string;
  /** Whether the map can be corrected at all. */
  editable: boolean;
  onClose: () => void;
}

export function FindingDetails({ finding, ...shared }: { finding: Finding } & Shared) {
  const { mark, kind, what, where, why, element, latitude, longitude } = finding;
  const { map, plan, digest, corrections, editable, onClose } = shared;
  return (
    <Card title={words(kind)} mark={<MarkIcon mark={mark} title={MARK_NAMES[mark]} />} onClose={onClose}>
      <dl className={classes.facts}>
        <Fact name={mark === "skipped" ? "Left out" : mark === "corrected" ? "Now" : "Taken"}>{what}</Fact>
        <Fact name="Where">
          {where === element ? null : where} {element ? <Source element={element} /> : null}
        </Fact>
        <Fact name={mark === "skipped" ? "Because" : mark === "corrected" ? "Instead" : "From"}>{why}</Fact>
        {mark === "skipped" || mark === "corrected" ? null : <Fact name="How sure">{mark}</Fact>}
        <Fact name="Position">
          {latitude.toFixed(6)}°, {longitude.toFixed(6)}°
        </Fact>
      </dl>
      {editable && mark !== "corrected" ? (
        <FindingEditor key={`${digest} ${finding.id}`} map={map} plan={plan} finding={finding} />
      ) : null}
      {editable ? (
        <TakeBack map={map} element={element} corrections={corrections} told={mark === "corrected"} />
      ) : (
        <NotEditable />
      )}
    </Card>
  );
}

export function RoadDetails({ road, ...shared }: { road: PlanRoad } & Shared) {
  const { map, plan, digest, corrections, editable, onClose } = shared;
  const [chosen, setChosen] = useState<number>();
  const lanes = lanesOf(plan, road);
  const [first] = lanes;
  const way = chosen !== undefined && road.ways.includes(chosen) ? chosen : road.ways[0];
  return (
    <Card title={road.name || "Road without a name"} mark={<Icon name="branch" size={15} />} onClose={onClose}>
      <dl className={classes.facts}>
        <Fact name="Lanes">
          {lanes.length}
          {lanes.some(({ open }) => !open) ? `, ${lanes.filter(({ open }) => !open).length} closed to cars` : ""}
        </Fact>
        <Fact name="Widths">{lanes.map(({ width }) => width.toFixed(2)).join(", ")} m, kerb first</Fact>
        <Fact name="Limit">{first ? `${Math.round(first.speed * 3.6)} km/h` : "–"}</Fact>
        <Fact name="Road">{road.id}</Fact>
        {way === undefined ? null : (
          <Fact name="Made of">
            {road.ways.length > 1 ? (
              <NativeSelect
                size="xs"
                aria-label="The way of the map that is corrected"
                value={way}
                data={road.ways.map((each) => ({ value: String(each), label: wayElement(each) }))}
                onChange={(event) => setChosen(Number(event.currentTarget.value))}
              />
            ) : null}
            <Source element={wayElement(way)} />
          </Fact>
        )}
      </dl>
      {editable && way !== undefined ? (
        <>
          <WayEditor key={`${digest} ${road.id} ${way}`} map={map} plan={plan} road={road} way={way} parts={ALL_PARTS} />
          <TakeBack map={map} element={wayElement(way)} corrections={corrections} />
        </>
      ) : null}
      {editable ? null : <NotEditable />}
    </Card>
  );
}

interface CardProps {
  title: string;
  mark: ReactNode;
  onClose: () => void;
  children: ReactNode;
}

function Card({ title, mark, onClose, children }: CardProps) {
  return (
    <section className={classes.details} aria-label={title} data-testid="details">
      <header>
        {mark}
        <h2>{title}</h2>
        <Tooltip label="Close (Esc)">
          <ActionIcon size="sm" variant="subtle" color="gray" aria-label="Close the details" onClick={onClose}>
            <Icon name="close" size={14} />
          </ActionIcon>
        </Tooltip>
      </header>
      {children}
    </section>
  );
}

function Fact({ name, children }: { name: string; children: ReactNode }) {
  return (
    <>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </>
  );
}

/** The element at its source, where one sees who has mapped it and how. */
function Source({ element }: { element: string }) {
  return (
    <Anchor
      size="xs"
      href={`https://www.openstreetmap.org/${element.replace(" ", "/")}`}
      target="_blank"
      rel="noreferrer"
      title="Open this element at openstreetmap.org"
    >
      {element}
    </Anchor>
  );
}

const NotEditable = () => (
  <Text size="xs" c="dimmed" mt={8}>
    This is a plain map file. To correct it, import it: drop it on this page.
  </Text>
);

interface TakeBackProps {
  map: string;
  element: string;
  corrections: readonly Correction[];
  /** Whether what was corrected stands above already. */
  told?: boolean;
}

/** The way back from a correction. */
function TakeBack({ map, element, corrections, told = false }: TakeBackProps) {
  const takeBack = useTakeBack(map);
  const own = corrections.find((correction) => correction.element === element);
  if (!own) return null;
  return (
    <div className={classes.undo}>
      <Text size="xs">{told ? "" : `Corrected: ${changeText(own.tags, own.removed)}`}</Text>
      <Button
        size="compact-xs"
        variant="default"
        data-testid="take-back"
        leftSection={<Icon name="undo" size={13} />}
        loading={takeBack.isPending}
        onClick={() => takeBack.mutate(element, { onError: notifyError })}
      >
        Take it back
      </Button>
    </div>
  );
}
