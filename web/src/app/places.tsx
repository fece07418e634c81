/** Small places: the way to the first scenario, and the page that does not exist. */

import { Button } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, Navigate, useNavigate } from "@tanstack/react-router";
import { scenarios } from "../api/queries";
import { lastScenario } from "../ui/memory";
import { Empty, Failure, Loading } from "../ui/State";

/** `/` is the studio with the scenario that was open last, or else the first sound one. */
export function FirstScenario() {
  const { data, error, refetch } = useQuery(scenarios);
  if (error) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="scenarios" />;
  const last = lastScenario();
  const first = data.find(({ id }) => id === last) ?? data.find(({ problem }) => problem === null) ?? data[0];
  if (first) return <Navigate to="/studio/$scenario" params={{ scenario: first.id }} search={{}} replace />;
  return (
    <Empty
      icon="car"
      title="No scenarios"
      action={
        <Button component={Link} to="/scenarios">
          Make one
        </Button>
      }
    >
      The scenarios folder holds no scenario file. Make one from a template, or import one.
    </Empty>
  );
}

export function NotFound() {
  const navigate = useNavigate();
  return (
    <Empty
      icon="unlinked"
      title="There is no such page"
      action={<Button onClick={() => navigate({ to: "/" })}>Open the studio</Button>}
    >
      The address leads nowhere. The studio, the scenarios, the runs, the queue, the comparison, the maps, the validation and the kinds
      are in the head of the page.
    </Empty>
  );
}
