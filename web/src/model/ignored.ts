/** What somebody does not want to see among the differences of runs: names, or beginnings of paths with a star. */

/** Whether a name is ignored: `radio.kind` is itself, `radio` and `radio.*` are all of it. */
export function isIgnored(name: string, list: readonly string[]): boolean {
  return list.some((each) => {
    const path = each.replace(/\.?\*$/, "");
    return name === path || name.startsWith(`${path}.`);
  });
}

/** A list as it is typed: names with commas or on lines, each once. */
export const listOf = (text: string): string[] => [...new Set(text.split(/[,\n]/).map((each) => each.trim()).filter((each) => each.replace(/\.?\*$/, "") !== ""))];
