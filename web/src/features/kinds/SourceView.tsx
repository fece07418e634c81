/** The file of a kind, read only: it follows the disk, and what Python cannot read in it is told at its line. */

import { Alert, Button, Code, Group, Text } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link } from "@tanstack/react-router";
import type { ReactNode } from "react";
import { type Manuscript, manuscript } from "../../api/queries";
import type { KnownKind } from "../../model/form";
import { Icon } from "../../ui/Icon";
import { notify, notifyError } from "../../ui/notify";
import { Failure, Loading } from "../../ui/State";
import classes from "./Kinds.module.css";

export function SourceView({ kind: { sort, name } }: { kind: KnownKind }) {
  const { data, error, refetch } = useQuery(manuscript(sort, name));
  if (error && !data) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the source" />;
  return (
    <section aria-label={`Source of ${name}`} className={classes.manuscript}>
      <Where found={data}>
        {sort === "application" ? (
          <Button component={Link} to="/source/$name" params={{ name } as never} size="compact-xs" mih={24} leftSection={<Icon name="pen" size={12} />}>
            {data.own ? `Edit ${name}` : `Read ${name} in the editor`}
          </Button>
        ) : null}
      </Where>
      <State found={data} />
      <Lines name={name} found={data} />
    </section>
  );
}

/** Where it lies, for an editor of one's own: what a browser sends is never run. */
function Where({ found: { file }, children }: { found: Manuscript; children: ReactNode }) {
  if (!file) return null;
  const copy = () => navigator.clipboard.writeText(file).then(() => notify("The path is copied.", "Open it in your editor."), notifyError);
  return (
    <Group gap="xs">
      {children}
      <Code className={classes.path}>{file}</Code>
      <Button size="compact-xs" variant="default" leftSection={<Icon name="copy" size={12} />} onClick={() => void copy()}>
        Copy the path
      </Button>
      <Text size="xs" c="dimmed">
        Open it in your editor: the text here follows the file.
      </Text>
    </Group>
  );
}

function State({ found: { missing, loaded, slips, refused } }: { found: Manuscript }) {
  if (missing) return <Told title="The file cannot be read">{missing}. Shown is what was loaded of it.</Told>;
  if (slips[0])
    return (
      <Told title={`Line ${slips[0].line}: ${slips[0].what}`}>Until that is mended, the version that was loaded last is used. Nothing of it is lost.</Told>
    );
  if (refused) return <Told title={`The file does not load: ${refused}`}>Until that is mended, runs use the last version that did.</Told>;
  if (loaded) return null;
  return <Told title="The file has changed since the studio was started">Its form is of the version before: start the studio again to have this one.</Told>;
}

const Told = ({ title, children }: { title: string; children: ReactNode }) => (
  <Alert color="yellow" variant="light" py={6} icon={<Icon name="warning" />} title={title} role="status">
    {children}
  </Alert>
);

function Lines({ name, found: { text, slips } }: { name: string; found: Manuscript }) {
  const wrong = new Map(slips.map(({ line, what }) => [line, what]));
  return (
    <pre className={classes.lines} tabIndex={0} aria-label={`Text of ${name}`}>
      {text.split("\n").map((line, number) => (
        <span key={`${number}`} className={classes.line} data-wrong={wrong.has(number + 1) || undefined} title={wrong.get(number + 1)}>
          {line}
          {"\n"}
        </span>
      ))}
    </pre>
  );
}
