/** Takes runs out of the studio, for a spreadsheet or a program of one's own. */

import { Button, Menu } from "@mantine/core";
import { Icon } from "../../ui/Icon";

interface Props {
  label: string;
  /** What is downloaded, and where from. */
  ways: readonly { label: string; href: string }[];
  disabled?: boolean;
}

export function ExportMenu({ label, ways, disabled = false }: Props) {
  return (
    <Menu position="bottom-end" shadow="md" disabled={disabled}>
      <Menu.Target>
        <Button size="xs" variant="default" disabled={disabled} leftSection={<Icon name="download" size={14} />}>
          {label}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {ways.map((way) => (
          <Menu.Item key={way.href} component="a" href={way.href} download>
            {way.label}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}
