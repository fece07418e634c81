/** Asks for what a new scenario begins with: a template, and the map that it is laid on. */

import { Button, Group, Modal, NativeSelect, Stack, Text } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link } from "@tanstack/react-router";
import { type FormEvent, useState } from "react";
import { maps } from "../../api/maps";
import { templates, useCreate } from "../../api/scenarios";
import { freeName, nameFor, nameProblem, plainName } from "../../model/scenario";
import { NameEntries } from "../../ui/NameDialog";
import { Failure, Loading } from "../../ui/State";

interface Props {
  /** Names that are taken. */
  taken: readonly string[];
  onClose: () => void;
  onMade: (scenario: string) => void;
}

export function NewDialog({ taken, onClose, onMade }: Props) {
  return (
    <Modal opened onClose={onClose} title="New scenario" size="md">
      <Choices taken={taken} onClose={onClose} onMade={onMade} />
    </Modal>
  );
}

function Choices({ taken, onClose, onMade }: Props) {
  const known = useQuery(templates);
  const places = useQuery(maps);
  const error = known.error ?? places.error;
  if (error) return <Failure error={error} onRetry={() => void Promise.all([known.refetch(), places.refetch()])} />;
  if (!known.data || !places.data) return <Loading what="templates and maps" />;
  const usable = places.data.filter(({ problem }) => problem === null);
  if (usable.length === 0) {
    return (
      <Text size="sm">
        A scenario needs a map, and there is none yet. <Link to="/maps">Import one</Link>: drop a map file, or type a place.
      </Text>
    );
  }
  return <Form templates={known.data} maps={usable} taken={taken} onClose={onClose} onMade={onMade} />;
}

interface FormProps extends Props {
  templates: { name: string; title: string; description: string }[];
  maps: { id: string; title: string }[];
}

function Form({ templates: known, maps: places, taken, onClose, onMade }: FormProps) {
  const [template, setTemplate] = useState(known[0]?.name ?? "");
  const [map, setMap] = useState(places[0]?.id ?? "");
  // Until somebody types them, title and file name follow from what is chosen.
  const [typedTitle, setTitle] = useState<string>();
  const [typedName, setName] = useState<string>();
  const create = useCreate();
  const chosen = known.find(({ name }) => name === template);
  const title = typedTitle ?? `${chosen?.title ?? ""} in ${places.find(({ id }) => id === map)?.title ?? ""}`.slice(0, 120);
  const name = typedName ?? freeName(nameFor(title) || "scenario", taken);
  const wrong = nameProblem(name, taken);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const body = { name: plainName(name), template, map, ...(title.trim() ? { title: title.trim() } : {}) };
    create.mutate(body, { onSuccess: ({ scenario }) => onMade(scenario) });
  };
  return (
    <form onSubmit={submit}>
      <Stack gap="sm">
        <NativeSelect
          size="sm"
          label="Template"
          data-autofocus
          data={known.map((each) => ({ value: each.name, label: each.title }))}
          value={template}
          description={chosen?.description}
          inputWrapperOrder={["label", "input", "description"]}
          onChange={(event) => setTemplate(event.currentTarget.value)}
        />
        <NativeSelect
          size="sm"
          label="Map"
          data={places.map((each) => ({ value: each.id, label: each.title }))}
          value={map}
          description="A way through it is drawn by lot. It stands under Routes, by its roads, and in the file's text."
          inputWrapperOrder={["label", "input", "description"]}
          onChange={(event) => setMap(event.currentTarget.value)}
        />
        <NameEntries name={name} onName={setName} wrong={wrong} title={title} onTitle={setTitle} />
        {create.error ? <Failure error={create.error} /> : null}
        <Group justify="flex-end" gap="xs">
          <Button size="xs" variant="default" onClick={onClose}>
            Cancel
          </Button>
          <Button size="xs" type="submit" loading={create.isPending} disabled={wrong !== ""}>
            Make it
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
