/** Everything that may be named in a scenario, with where it comes from, and the files that are broken. */

import { Alert, Button, CloseButton, Code, Table, Text, TextInput, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useRef, useState } from "react";
import { kinds } from "../../api/queries";
import { type KnownKind, settingsAtRest } from "../../model/form";
import { type BrokenKind, bySort, matchingKinds } from "../../model/kind";
import { formatValue, unitText, words } from "../../model/units";
import { Icon } from "../../ui/Icon";
import { Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import { NewApplication } from "./NewApplication";
import classes from "./Kinds.module.css";
import { SourceView } from "./SourceView";

export function KindsPage() {
  const { data, error, refetch } = useQuery(kinds);
  const [query, setQuery] = useState("");
  const search = useRef<HTMLInputElement>(null);
  const [beginning, setBeginning] = useState(false);
  useShortcuts({ "/": () => search.current?.focus() });
  if (error) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the kinds" />;
  const shown = matchingKinds(data.kinds, query);
  return (
    <article className={classes.page}>
      <header className={classes.head}>
        <Title order={1} fz="lg">
          Kinds
        </Title>
        <TextInput
          ref={search}
          size="xs"
          w={260}
          placeholder="Search kinds (/)"
          aria-label="Search kinds"
          leftSection={<Icon name="search" size={14} />}
          rightSection={
            query ? <CloseButton size="xs" aria-label="Clear the search" onClick={() => setQuery("")} /> : null
          }
          value={query}
          onChange={(event) => setQuery(event.currentTarget.value)}
        />
        <Button size="xs" variant="default" ml="auto" leftSection={<Icon name="plus" size={14} />} onClick={() => setBeginning(true)}>
          New application …
        </Button>
      </header>
      <Text size="sm" c="dimmed">
        Whatever a scenario may name is a kind: one file. Yours stand in the folder that <Code>--kinds</Code> names;{" "}
        <Code>studio new sensor NAME</Code> begins one.
      </Text>
      {data.broken.map((each) => (
        <Broken key={each.file} broken={each} />
      ))}
      {shown.length === 0 ? <Text size="sm">No kind matches “{query}”.</Text> : null}
      {bySort(shown).map(([sort, some]) => (
        <section key={sort} aria-label={words(sort)}>
          <Title order={2} fz="md" mb={4}>
            {words(sort)}
          </Title>
          {some.map((kind) => (
            <Entry key={kind.name} kind={kind} />
          ))}
        </section>
      ))}
      {beginning ? <NewApplication onClose={() => setBeginning(false)} /> : null}
    </article>
  );
}

/** A file that gave no kind: nobody else is hurt, and its author sees why. */
function Broken({ broken: { name, file, what, traceback } }: { broken: BrokenKind }) {
  return (
    <Alert color="red" variant="outline" icon={<Icon name="warning" />} title={`${name} is broken`} data-testid="broken-kind">
      <Text size="sm" mb={4}>
        {file}: {what}
      </Text>
      <pre className={classes.traceback} tabIndex={0} aria-label={`Why ${name} is broken`}>
        {traceback}
      </pre>
    </Alert>
  );
}

function Entry({ kind }: { kind: KnownKind }) {
  const { sort, name, title, source, description } = kind;
  return (
    <details className={classes.kind} data-testid={`kind-${sort}.${name}`}>
      <summary className={classes.summary}>
        <b>{title}</b> <Code>{name}</Code>
        <span className={classes.source}>{source}</span>
      </summary>
      <div className={classes.body}>
        <p className={classes.description}>{description}</p>
        <Settings kind={kind} />
        <Gives kind={kind} />
        <Source kind={kind} />
      </div>
    </details>
  );
}

/** Its file, asked for when it is opened. */
function Source({ kind }: { kind: KnownKind }) {
  const [open, setOpen] = useState(false);
  return (
    <>
      <button type="button" className={classes.opener} aria-expanded={open} onClick={() => setOpen(!open)}>
        <Icon name={open ? "down" : "right"} size={12} /> Source
      </button>
      {open ? <SourceView kind={kind} /> : null}
    </>
  );
}

function Settings({ kind }: { kind: KnownKind }) {
  const fields = settingsAtRest(kind);
  if (fields.length === 0) return null;
  const rows = fields.map(({ path, label, unit, initial, allowed, choices }) => [
    path,
    label,
    unit,
    formatValue(initial),
    allowed || choices.join(", "),
  ]);
  return <Rows caption="What may be set" head={["Setting", "Meaning", "Unit", "Default", "Allowed"]} rows={rows} />;
}

function Gives({ kind: { gives } }: { kind: KnownKind }) {
  if (gives.length === 0) return null;
  const rows = gives.map(({ name, unit, size, meaning }) => [name, meaning, unitText(unit), size > 1 ? String(size) : ""]);
  return <Rows caption="What it gives" head={["Name", "Meaning", "Unit", "Numbers"]} rows={rows} />;
}

function Rows({ caption, head, rows }: { caption: string; head: string[]; rows: string[][] }) {
  return (
    <Table verticalSpacing={2} horizontalSpacing={8} fz="sm" w="auto" captionSide="top">
      <Table.Caption ta="left" mt={4} mb={0}>
        {caption}
      </Table.Caption>
      <Table.Thead>
        <Table.Tr>
          {head.map((each) => (
            <Table.Th key={each}>{each}</Table.Th>
          ))}
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {rows.map(([name, ...cells]) => (
          <Table.Tr key={name}>
            <Table.Td>
              <Code>{name}</Code>
            </Table.Td>
            {cells.map((cell, column) => (
              <Table.Td key={head[column + 1]}>{cell}</Table.Td>
            ))}
          </Table.Tr>
        ))}
      </Table.Tbody>
    </Table>
  );
}
