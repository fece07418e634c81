/** Choices are found by their titles, and by the names that they have in files and commands. */

import type { ComboboxItem, OptionsFilter } from "@mantine/core";

export const byTitleOrName: OptionsFilter = ({ options, search }) => {
  const wanted = search.trim().toLowerCase();
  return (options as ComboboxItem[]).filter(({ label, value }) => label.toLowerCase().includes(wanted) || value.toLowerCase().includes(wanted));
};
