/** What is drawn over the scene: a switch for each layer, and why nothing of it is to be seen. */

import { Button, Checkbox, Popover, Stack, Text } from "@mantine/core";
import { LAYERS, toggled, whyNot } from "../../model/layer";
import { Icon } from "../../ui/Icon";

interface Props {
  on: readonly string[];
  onChange: (on: readonly string[]) => void;
  /** Whether a run is shown, live or played back. */
  running: boolean;
  /** Layers that cannot be drawn, and why. */
  missing: Readonly<Record<string, string>>;
}

export function LayersMenu({ on, onChange, running, missing }: Props) {
  return (
    <Popover position="bottom-end" withinPortal shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Button size="xs" variant="default" leftSection={<Icon name="eye" size={14} />}>
          Layers
        </Button>
      </Popover.Target>
      <Popover.Dropdown aria-label="Layers of the scene">
        <Stack gap={6} maw={300}>
          {LAYERS.map(({ name, label, about }) => {
            const why = whyNot(name, running, missing);
            return (
              <Checkbox
                key={name}
                size="xs"
                label={label}
                description={why ? `Not shown: ${why}` : about}
                checked={on.includes(name)}
                onChange={() => onChange(toggled(on, name))}
              />
            );
          })}
          <Text size="xs" c="dimmed">
            Nothing hides them: what is behind a house is seen too. Click a car to follow it.
          </Text>
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}
