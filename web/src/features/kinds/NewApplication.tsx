/** The gallery of starts: what `studio new application` writes, and the applications that come with the studio, as the start of one's own. */

import { Button, Code, Group, Modal, Stack, Text, TextInput } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useNavigate } from "@tanstack/react-router";
import { type FormEvent, useState } from "react";
import { applicationStarts, kinds } from "../../api/queries";
import { applicationNameProblem } from "../../model/source";
import { Failure, Loading } from "../../ui/State";
import classes from "./Sources.module.css";

interface Props {
  /** The start that is chosen at first. */
  start?: string;
  onClose: () => void;
}

export function NewApplication({ start = "new", onClose }: Props) {
  const starts = useQuery(applicationStarts);
  const known = useQuery(kinds).data?.kinds ?? [];
  const taken = known.filter(({ sort }) => sort === "application").map(({ name }) => name);
  const navigate = useNavigate();
  const [chosen, setChosen] = useState(start);
  const [name, setName] = useState(start === "new" ? "mine" : `my_${start}`);
  const wrong = applicationNameProblem(name, taken);
  const begin = (event: FormEvent) => {
    event.preventDefault();
    if (!wrong) void navigate({ to: "/source/$name", params: { name }, search: { start: chosen } });
  };
  return (
    <Modal opened onClose={onClose} title="New application" size="lg">
      <form onSubmit={begin}>
        <Stack gap="sm">
          <TextInput
            label="Name"
            description="Of the application, and of its file"
            value={name}
            error={wrong || undefined}
            onChange={(event) => setName(event.currentTarget.value)}
            data-autofocus
          />
          {starts.error ? <Failure error={starts.error} onRetry={() => void starts.refetch()} /> : null}
          {starts.isPending ? <Loading what="the starts" /> : null}
          <fieldset className={classes.starts}>
            <legend>Begin with</legend>
            {starts.data?.map((each) => (
              <label key={each.name} className={classes.start}>
                <input type="radio" name="start" checked={chosen === each.name} onChange={() => setChosen(each.name)} />
                <span>
                  <b>{each.title}</b>
                  <small>{each.explanation.split("\n")[0]}</small>
                </span>
              </label>
            ))}
          </fieldset>
          <Text size="xs" c="dimmed">
            <Code>studio new application {name || "NAME"}</Code> writes the first of them with a test and a scenario beside it.
          </Text>
          <Group justify="flex-end" gap="xs">
            <Button size="xs" variant="default" onClick={onClose}>
              Cancel
            </Button>
            <Button size="xs" type="submit" disabled={wrong !== ""}>
              Begin
            </Button>
          </Group>
        </Stack>
      </form>
    </Modal>
  );
}
