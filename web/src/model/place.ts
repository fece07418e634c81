/** What a user gives to make a map of: a file with a name, a place, or a box. */

const ENDINGS = [".osm.gz", ".osm.pbf", ".osm", ".json", ".xodr"];

/** The name that was typed, with the file's ending, which tells the server what it holds. */
export function nameFor(file: Pick<File, "name">, typed: string): string {
  const ending = ENDINGS.find((each) => file.name.toLowerCase().endsWith(each)) ?? "";
  const name = typed.trim();
  if (name === "") return file.name;
  return name.toLowerCase().endsWith(ending) ? name : `${name}${ending}`;
}

/** A place, or a box when the text is four numbers: west, south, east, north [deg]. */
export function placeOrBox(text: string): { place: string } | { bbox: [number, number, number, number] } {
  const numbers = text.split(/[\s,;]+/).filter(Boolean).map(Number);
  const [west, south, east, north] = numbers;
  const isBox = numbers.length === 4 && numbers.every(Number.isFinite);
  return isBox ? { bbox: [west, south, east, north] as [number, number, number, number] } : { place: text.trim() };
}
