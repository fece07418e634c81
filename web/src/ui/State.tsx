/** What stands where data would stand: nothing yet, still loading, or refused. */

import { Alert, Button, Center, Loader, Stack, Text, Title } from "@mantine/core";
import type { ReactNode } from "react";
import type { Problem } from "../model/run";
import { Icon, type IconName } from "./Icon";
import { ProblemList } from "./Problems";

interface EmptyProps {
  icon: IconName;
  title: string;
  children: ReactNode;
  action?: ReactNode;
}

/** An empty place says what would be here and what to do next. */
export function Empty({ icon, title, children, action }: EmptyProps) {
  return (
    <Center p="lg" h="100%">
      <Stack align="center" gap={6} maw={440}>
        <Text c="dimmed" component="span">
          <Icon name={icon} size={30} />
        </Text>
        <Title order={2} fz="md">
          {title}
        </Title>
        <Text size="sm" c="dimmed" ta="center">
          {children}
        </Text>
        {action}
      </Stack>
    </Center>
  );
}

export function Loading({ what }: { what: string }) {
  return (
    <Center p="lg" h="100%" role="status">
      <Loader size="sm" mr="sm" />
      <Text size="sm" c="dimmed">
        Loading {what} …
      </Text>
    </Center>
  );
}

interface FailureProps {
  error: Error & { problems?: Problem[] };
  onRetry?: () => void;
  onDismiss?: () => void;
}

export function Failure({ error, onRetry, onDismiss }: FailureProps) {
  return (
    <Alert
      color="red"
      variant="outline"
      title={error.message}
      icon={<Icon name="warning" />}
      m="md"
      maw={640}
      {...(onDismiss ? { withCloseButton: true, closeButtonLabel: "Close this message", onClose: onDismiss } : {})}
    >
      <ProblemList problems={error.problems ?? []} />
      {onRetry ? (
        <Button size="xs" variant="default" mt="xs" onClick={onRetry}>
          Try again
        </Button>
      ) : null}
    </Alert>
  );
}
