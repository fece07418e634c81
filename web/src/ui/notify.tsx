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

/** Tell that something has happened. */
export function notify(title: string, message: ReactNode, color = "teal"): void {
  notifications.show({ color, title, message, autoClose: 6000, withBorder: true });
}
