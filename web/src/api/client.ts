/** Requests to the studio server, typed by its own description; what goes wrong comes back as one kind of error. */

import createClient from "openapi-fetch";
import type { Problem } from "../model/run";
import type { paths } from "../model/server";

/** The server's routes; wrong paths, parameters and bodies do not compile. */
export const client = createClient<paths>({
  baseUrl: location.origin,
  fetch: (request) => globalThis.fetch(request),
});

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

interface Outcome<Answer> {
  data?: Answer;
  error?: unknown;
  response: Response;
}

/** What the server says, of the type that it describes itself, or an error. */
export async function answer<Answer>(outcome: Promise<Outcome<Answer>>): Promise<Answer> {
  const { data, error, response } = await outcome.catch(() => {
    throw new Unreachable();
  });
  if (response.ok) return data as Answer;
  throw refusal(error, response.status);
}

/** Read the error body of the contract; anything else is told by its status. */
export function refusal(body: unknown, status: number): Error {
  const { message, problems } = (typeof body === "object" && body !== null ? body : {}) as Partial<Refusal>;
  // A development proxy answers 502 or 504 when the server behind it is gone.
  if (message === undefined && status >= 502) return new Unreachable();
  return new Refusal(
    message ?? `The server answered ${status}.`,
    Array.isArray(problems) ? problems : [],
    status,
  );
}
