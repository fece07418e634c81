/** Up to eight runs beside each other: what was different in, what came out, and how it went. */

import { Button, Switch, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useNavigate } from "@tanstack/react-router";
import { useState } from "react";
import { beside, runs } from "../../api/queries";
import { Empty, Failure, Loading } from "../../ui/State";
import classes from "./Compare.module.css";
import { Differences } from "./Differences";
import { Metrics } from "./Metrics";
import { Overlay } from "./Overlay";
import { Sides } from "./Sides";
import { Sources } from "./Sources";

interface Props {
  /** The numbers of the runs; the others are compared with the first. */
  chosen: readonly number[];
  onChoose: (chosen: number[]) => void;
}

export function ComparePage({ chosen, onChoose }: Props) {
  const { data: all, error } = useQuery(runs());
  const [everything, setEverything] = useState(false);
  if (error && !all) return <Failure error={error} />;
  if (!all) return <Loading what="runs" />;
  return (
    <div className={classes.page}>
      <div className={classes.sides}>
        <Title order={1} fz="lg">
          Compare
        </Title>
        <Sides chosen={chosen} all={all} onChoose={onChoose} />
        <Switch
          size="xs"
          ml="auto"
          label="Also what is the same"
          checked={everything}
          onChange={(event) => setEverything(event.currentTarget.checked)}
        />
      </div>
      {chosen.length < 2 ? <Choose few={all.length < 2} /> : <Compared chosen={chosen} everything={everything} />}
    </div>
  );
}

function Choose({ few }: { few: boolean }) {
  const navigate = useNavigate();
  if (!few)
    return (
      <Empty
        icon="compare"
        title="Choose two runs or more"
        action={
          <Button variant="default" size="xs" onClick={() => navigate({ to: "/runs", search: {} })}>
            Choose them in the table
          </Button>
        }
      >
        Add them above, or select rows in the table of runs. The others are compared with the first one.
      </Empty>
    );
  return (
    <Empty
      icon="compare"
      title="There are not two runs yet"
      action={<Button onClick={() => navigate({ to: "/" })}>Open the studio</Button>}
    >
      Run a scenario, change a parameter and run it again: the two are compared here.
    </Empty>
  );
}

function Compared({ chosen, everything }: { chosen: readonly number[]; everything: boolean }) {
  const { data, error, refetch } = useQuery(beside(chosen, everything));
  if (error) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the comparison" />;
  return (
    <>
      <Differences found={data} />
      <Overlay found={data} />
      <Metrics found={data} everything={everything} />
      <Sources found={data} />
    </>
  );
}
