/** Asks before a map is deleted. */

import { Button, Group, Modal, Text } from "@mantine/core";
import { useDelete } from "../../api/maps";
import type { MapRow } from "../../model/map";
import { Failure } from "../../ui/State";

interface Props {
  /** The map in question; undefined when nothing is asked. */
  map: MapRow | undefined;
  onClose: () => void;
  onDeleted?: () => void;
}

export function DeleteQuestion({ map, onClose, onDeleted }: Props) {
  const remove = useDelete();
  const close = () => {
    remove.reset();
    onClose();
  };
  const confirm = () => {
    if (!map) return;
    remove.mutate(map.id, {
      onSuccess: () => {
        close();
        onDeleted?.();
      },
    });
  };
  return (
    <Modal opened={map !== undefined} onClose={close} title={`Delete the map ${map?.title ?? ""}?`} size="sm">
      <Text size="sm">
        Its folder goes, with the map file and everything that was corrected. Runs that were driven there keep their
        results.
      </Text>
      {remove.error ? <Failure error={remove.error} /> : null}
      <Group justify="flex-end" mt="md">
        <Button size="xs" variant="default" onClick={close} data-autofocus>
          Keep it
        </Button>
        <Button size="xs" color="red" onClick={confirm} loading={remove.isPending} data-testid="delete-map">
          Delete
        </Button>
      </Group>
    </Modal>
  );
}
