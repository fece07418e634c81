/** Asks for what a new validation project begins with: a name, and the car that is to be validated. */

import { Button, Group, Modal, NativeSelect, Stack } from "@mantine/core";
import { type FormEvent, useState } from "react";
import type { Problem } from "../../model/run";
import { freeName, nameFor, nameProblem, plainName } from "../../model/scenario";
import { NameEntries } from "../../ui/NameDialog";
import { Failure } from "../../ui/State";

interface Props {
  vehicles: readonly { name: string; title: string }[];
  taken: readonly string[];
  error: (Error & { problems?: Problem[] }) | null;
  pending: boolean;
  onClose: () => void;
  onMake: (made: { name: string; title: string; vehicle: string }) => void;
}

export function NewProject({ vehicles, taken, error, pending, onClose, onMake }: Props) {
  const [vehicle, setVehicle] = useState(vehicles[0]?.name ?? "");
  const [title, setTitle] = useState("My car");
  const [typed, setName] = useState<string>();
  const name = typed ?? freeName(nameFor(title) || "project", taken);
  const wrong = nameProblem(name, taken).replace("scenario", "project");
  const submit = (event: FormEvent) => {
    event.preventDefault();
    onMake({ name: plainName(name), title: title.trim() || plainName(name), vehicle });
  };
  return (
    <Modal opened onClose={onClose} title="New validation project" size="md">
      <form onSubmit={submit}>
        <Stack gap="sm">
          <NativeSelect
            size="sm"
            label="Vehicle"
            data-autofocus
            data={vehicles.map((each) => ({ value: each.name, label: each.title }))}
            value={vehicle}
            description="The car of the catalogue that is nearest to the recorded one; calibration changes it."
            inputWrapperOrder={["label", "input", "description"]}
            onChange={(event) => setVehicle(event.currentTarget.value)}
          />
          <NameEntries name={name} onName={setName} wrong={wrong} title={title} onTitle={setTitle} folder />
          {error ? <Failure error={error} /> : null}
          <Group justify="flex-end" gap="xs">
            <Button size="xs" variant="default" onClick={onClose}>
              Cancel
            </Button>
            <Button size="xs" type="submit" loading={pending} disabled={wrong !== ""}>
              Make it
            </Button>
          </Group>
        </Stack>
      </form>
    </Modal>
  );
}
