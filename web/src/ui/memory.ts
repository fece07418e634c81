/** What the browser remembers of scenarios: which was open last, and what the next run of each will be started with. */

const LAST = "last scenario";
export const draftKey = (id: string): string => `draft ${id}`;

/** Under which the charts of a scenario are kept. */
export const chartsKey = (id: string): string => `charts ${id}`;

/** The scenario that was open last. */
export const lastScenario = (): string | null => localStorage.getItem(LAST);

/** Remember the scenario for the next visit. */
export const rememberScenario = (id: string): void => localStorage.setItem(LAST, id);

/** A scenario has another name from now on. */
export function moveMemory(from: string, to: string): void {
  if (lastScenario() === from) rememberScenario(to);
  const charts = localStorage.getItem(chartsKey(from));
  if (charts !== null) localStorage.setItem(chartsKey(to), charts);
  localStorage.removeItem(chartsKey(from));
  const draft = sessionStorage.getItem(draftKey(from));
  if (draft === null) return;
  sessionStorage.setItem(draftKey(to), draft);
  sessionStorage.removeItem(draftKey(from));
}
