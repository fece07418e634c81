/** A recorded channel of one run, or of several beside each other, in a few numbers: of all of it or of a stretch, and at an event. */

import { Group, NativeSelect, Table, Text } from "@mantine/core";
import { useState } from "react";
import { commonKinds } from "../model/beside";
import type { RunDetail, Server } from "../model/run";
import { boundOf, common, NAMES } from "../model/aggregate";
import { formatNumber, formatTime, withUnit, words } from "../model/units";
import { BoundInput, ChannelSelect } from "./ChannelFields";
import { Failure, Loading } from "./State";

interface Asked {
  runs: readonly number[];
  channel: string;
  begin: number | undefined;
  end: number | undefined;
  event: string;
}

interface Props {
  runs: readonly RunDetail[];
  /** Asks the server, once that makes sense. */
  useFound: (asked: Asked, isAsked: boolean) => { data: Found | undefined; error: Error | null; refetch: () => unknown };
}

export function Aggregates({ runs, useFound }: Props) {
  const channels = common(runs);
  const [chosen, setChosen] = useState<string>();
  const [from, setFrom] = useState("");
  const [to, setTo] = useState("");
  const [event, setEvent] = useState("");
  const channel = channels.find(({ name }) => name === chosen) ?? channels.find(({ name }) => name.endsWith(".speed")) ?? channels[0];
  const [begin, end] = [boundOf(from), boundOf(to)];
  const isAsked = channel !== undefined && begin !== null && end !== null;
  const asked = { runs: runs.map(({ run }) => run), channel: channel?.name ?? "", begin: begin ?? undefined, end: end ?? undefined, event };
  const { data, error, refetch } = useFound(asked, isAsked);
  if (!channel) return <Text size="sm">No channel was recorded in {runs.length > 1 ? "all of them" : "it"}.</Text>;
  return (
    <>
      <Group gap="xs" align="flex-start">
        <ChannelSelect channels={channels} value={channel.name} onChange={setChosen} />
        <BoundInput label="From [s]" placeholder="beginning" value={from} onChange={setFrom} />
        <BoundInput label="To [s]" placeholder="end" value={to} onChange={setTo} />
        <NativeSelect
          size="xs"
          label="At the first"
          value={event}
          onChange={({ currentTarget: { value } }) => setEvent(value)}
          data={[{ value: "", label: "no event" }, ...commonKinds(runs.map(({ events }) => events)).map((kind) => ({ value: kind, label: words(kind) }))]}
        />
      </Group>
      {isAsked && error ? <Failure error={error} onRetry={() => void refetch()} /> : null}
      {isAsked && !error && !data ? <Loading what="the numbers" /> : null}
      {isAsked && !error && data ? <Found found={data} channel={channel} isAtEvent={event !== ""} /> : null}
    </>
  );
}

type Found = Server["Aggregated"][];

function Found({ found, channel, isAtEvent }: { found: Found; channel: { name: string; unit: string }; isAtEvent: boolean }) {
  const kinds = (found[0]?.aggregates ?? []).filter(({ kind }) => isAtEvent || kind !== "at_event");
  return (
    <Table verticalSpacing={3} horizontalSpacing={8} fz="sm" mt={6} aria-label={`Numbers of ${channel.name}`}>
      <Table.Thead>
        <Table.Tr>
          <Table.Th>{withUnit(channel.name, channel.unit)}</Table.Th>
          {found.map(({ run, begin, end, samples }) => (
            <Table.Th key={run} ta="right" title={`${samples} samples from ${formatTime(begin)} to ${formatTime(end)} s`}>
              #{run}
            </Table.Th>
          ))}
          <Table.Th>is</Table.Th>
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody style={{ fontVariantNumeric: "tabular-nums" }}>
        {kinds.map(({ kind, meaning }) => (
          <Table.Tr key={kind}>
            <Table.Th scope="row">{NAMES[kind]}</Table.Th>
            {found.map(({ run, aggregates: own }) => {
              const { value, time } = own.find((each) => each.kind === kind) ?? {};
              return (
                <Table.Td key={run} ta="right" title={typeof time === "number" ? `at ${formatTime(time)} s` : undefined}>
                  {typeof value === "number" ? formatNumber(value) : "–"}
                </Table.Td>
              );
            })}
            <Table.Td c="dimmed">{meaning}</Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </Table>
  );
}
