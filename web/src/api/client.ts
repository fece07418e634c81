/** Requests to the studio server; what goes wrong comes back as one kind of error. */

import type { Problem } from "../model/run";

/** A refusal of the server: one sentence, and the problems it is made of. */
export class Refusal extends Error {
  constructor(
    message: string,
    readonly problems: Problem[],
    readonly status: number,
  ) {
    super(message);
    this.name = "Refusal";
  }
}

/** The server did not answer at all. */
export class Unreachable extends Error {
  constructor() {
    super("The studio server does not answer.");
    this.name = "Unreachable";
  }
}

async function request<T>(path: string, init: RequestInit): Promise<T> {
  const response = await fetch(path, init).catch(() => {
    throw new Unreachable();
  });
  if (response.ok) return (await response.json()) as T;
  throw await refusal(response);
}

/** Read the error body of the contract; anything else is told by its status. */
async function refusal(response: Response): Promise<Error> {
  const body = await response.json().catch(() => ({}));
  // A development proxy answers 502 or 504 when the server behind it is gone.
  if (typeof body.message !== "string" && response.status >= 502) return new Unreachable();
  const message = typeof body.message === "string" ? body.message : `The server answered ${response.status}.`;
  return new Refusal(message, Array.isArray(body.problems) ? body.problems : [], response.status);
}

export const get = <T>(path: string): Promise<T> => request<T>(path, { method: "GET" });

export const post = <T>(path: string, body: unknown = {}): Promise<T> =>
  request<T>(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
