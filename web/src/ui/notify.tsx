/** Short notices in the corner. */

import { notifications } from "@mantine/notifications";
import type { ReactNode } from "react";
import type { Problem } from "../model/run";
import { ProblemList } from "./Problems";

/** Tell that something was refused, with the problems it is made of. */
export function notifyError(error: Error & { problems?: Problem[] }): void {
  notifications.show({
    color: "red",
    title: error.message,
    message: <ProblemList problems={error.problems ?? []} />,
    autoClose: 12000,
    withBorder: true,
  });
}

/** [ms] How long a notice stays that has something to press in it: time to read it and to get there, on a slow machine too. */
export const PRESSED = 30_000;

interface How {
  /** By which it can be closed. */
  id?: string;
  autoClose?: number;
}

/** Tell that something has happened. */
export function notify(title: string, message: ReactNode, color = "teal", how: How = {}): void {
  notifications.show({ color, title, message, autoClose: 6000, withBorder: true, ...how });
}

/** Take a notice away that says nothing true any more. */
export const closeNotice = (id: string): void => void notifications.hide(id);
