/** Which runs are compared: each can be exchanged, taken out, or made the one that the others are compared with. */

import { ActionIcon, Badge, CloseButton, Group, NativeSelect, Tooltip } from "@mantine/core";
import { Stroke } from "../../charts/Stroke";
import { MOST } from "../../model/beside";
import type { ListedRun } from "../../model/run";
import { useDark } from "../../ui/dark";
import { Icon } from "../../ui/Icon";
import { styleOf } from "./line";

interface Props {
  chosen: readonly number[];
  all: readonly ListedRun[];
  onChoose: (chosen: number[]) => void;
}

export function Sides({ chosen, all, onChoose }: Props) {
  const places = chosen.length < MOST ? [...chosen, undefined] : [...chosen];
  const put = (place: number, run: number | undefined) => {
    const next = [...chosen.slice(0, place), ...(run === undefined ? [] : [run]), ...chosen.slice(place + 1)];
    onChoose([...new Set(next)]);
  };
  return places.map((run, place) => (
    <Side
      key={run ?? "next"}
      place={place}
      run={run}
      of={chosen.length}
      all={all.filter((other) => other.run === run || !chosen.includes(other.run))}
      onChange={(next) => put(place, next)}
      onFirst={() => onChoose([run as number, ...chosen.filter((other) => other !== run)])}
    />
  ));
}

interface SideProps {
  place: number;
  /** Nothing where one may be added. */
  run: number | undefined;
  of: number;
  all: readonly ListedRun[];
  onChange: (run: number | undefined) => void;
  onFirst: () => void;
}

/** One of them, with the line that stands for it in the charts. */
function Side({ place, run, of, all, onChange, onFirst }: SideProps) {
  const dark = useDark();
  const known = all.some((other) => other.run === run);
  const label = run === undefined ? "Add a run" : place === 0 ? "Baseline" : `Run ${place + 1}`;
  const choices = all.map((other) => ({ value: String(other.run), label: named(other) }));
  return (
    <Group gap={4} wrap="nowrap" role="group" aria-label={label}>
      {run === undefined ? null : <Stroke {...styleOf({ place, of, vehicle: 0, color: "currentColor", dark })} width={26} />}
      {run !== undefined && place === 0 ? (
        <Badge variant="light" size="sm" tt="none">
          baseline
        </Badge>
      ) : null}
      <NativeSelect
        size="xs"
        aria-label={label}
        data-testid={run === undefined ? "compare-add" : `compare-${place}`}
        value={run === undefined ? "" : String(run)}
        onChange={({ currentTarget: { value } }) => onChange(value === "" ? undefined : Number(value))}
        data={[
          ...(run === undefined ? [{ value: "", label: "Add a run …" }] : []),
          ...(run !== undefined && !known ? [{ value: String(run), label: `#${run}` }] : []),
          ...choices,
        ]}
      />
      {run === undefined ? null : (
        <>
          {place === 0 ? null : (
            <Tooltip label="Compare the others with this one">
              <ActionIcon variant="subtle" size={24} aria-label={`Make run ${run} the baseline`} onClick={onFirst}>
                <Icon name="swap" size={14} />
              </ActionIcon>
            </Tooltip>
          )}
          <CloseButton size="sm" aria-label={`Take run ${run} out`} onClick={() => onChange(undefined)} />
        </>
      )}
    </Group>
  );
}

const named = ({ run, name, scenario, status }: ListedRun) => [`#${run}`, name || scenario, status === "done" ? "" : `(${status})`].join(" ");
