/** Asks before a place with unsaved text is left. */

import { Button, Group, Modal, Text } from "@mantine/core";

interface LeaveProps {
  leave: { status: string; proceed?: (() => void) | undefined; reset?: (() => void) | undefined };
  pending: boolean;
  onSave: () => void;
  canSave: boolean;
}

/** Unsaved text is told before it is left. */
export function LeaveQuestion({ leave: { status, proceed, reset }, pending, onSave, canSave }: LeaveProps) {
  return (
    <Modal opened={status === "blocked"} onClose={() => reset?.()} title="Leave without saving?" size="sm">
      <Text size="sm">What you have changed in this text is not saved.</Text>
      <Group justify="flex-end" gap="xs" mt="md">
        <Button size="xs" variant="default" onClick={() => reset?.()} data-autofocus>
          Stay
        </Button>
        <Button size="xs" variant="default" onClick={() => proceed?.()}>
          Leave, lose it
        </Button>
        {canSave ? (
          <Button size="xs" loading={pending} onClick={onSave}>
            Save, then leave
          </Button>
        ) : null}
      </Group>
    </Modal>
  );
}
