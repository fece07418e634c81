/** What is wrong: where, what, which value, what is allowed, and the remedy. */

import { Text } from "@mantine/core";
import type { Problem } from "../model/run";

export function ProblemText({ problem, withPlace = true }: { problem: Problem; withPlace?: boolean }) {
  return (
    <Text size="xs" component="p" m={0} style={{ overflowWrap: "anywhere" }}>
      {withPlace && problem.where ? <b>{problem.where}: </b> : null}
      {problem.what}
      {problem.value ? ` (got ${problem.value})` : ""}
      {problem.allowed ? `; allowed: ${problem.allowed}` : ""}
      {problem.remedy ? `; ${problem.remedy}` : ""}
    </Text>
  );
}

export function ProblemList({ problems }: { problems: readonly Problem[] }) {
  return problems.map((problem) => (
    <ProblemText key={`${problem.where} ${problem.what}`} problem={problem} />
  ));
}
