/** The ways to a new map: a file, or the name or the box of a place. */

import { Button, Checkbox, FileButton, Text, TextInput, Tooltip } from "@mantine/core";
import { type FormEvent, type RefObject, useRef, useState } from "react";
import { useDownload } from "../../api/maps";
import type { MapJob } from "../../model/map";
import { placeOrBox } from "../../model/place";
import type { Problem } from "../../model/run";
import { Icon } from "../../ui/Icon";
import { ProblemList } from "../../ui/Problems";
import classes from "./Maps.module.css";

/** What is asked of an import besides its source. */
export interface Wishes {
  name: string;
  bbox: string;
  /** An import of the same name is made anew; its corrections are kept. */
  replace: boolean;
}

interface Props {
  wishes: Wishes;
  onWishes: (wishes: Wishes) => void;
  onFiles: (files: File[]) => void;
  onStarted: (job: MapJob) => void;
  /** Gets the keyboard with `/`. */
  field: RefObject<HTMLInputElement | null>;
}

export function ImportPanel({ wishes, onWishes, onFiles, onStarted, field }: Props) {
  // The same file may be chosen again, which a browser would not tell otherwise.
  const reset = useRef<() => void>(null);
  const take = (files: File[]) => {
    onFiles(files);
    reset.current?.();
  };
  return (
    <section className={classes.importing} aria-label="Make a new map">
      <div className={classes.way}>
        <h2>From a file</h2>
        <Text size="xs" c="dimmed">
          OpenStreetMap data (.osm, .osm.gz, .osm.pbf, or .json from an Overpass server) or OpenDRIVE (.xodr). Drop it
          anywhere on this page, or choose it:
        </Text>
        <FileButton onChange={take} resetRef={reset} multiple inputProps={INPUT}>
          {(props) => (
            <Button {...props} size="xs" data-testid="choose-file" leftSection={<Icon name="upload" size={14} />}>
              Choose a map file
            </Button>
          )}
        </FileButton>
      </div>
      <DownloadForm wishes={wishes} onStarted={onStarted} field={field} />
      <div className={classes.way}>
        <h2>Options</h2>
        <TextInput
          size="xs"
          label="Name of the map"
          placeholder="as the file or the place"
          value={wishes.name}
          onChange={(event) => onWishes({ ...wishes, name: event.currentTarget.value })}
        />
        <TextInput
          size="xs"
          label="Only this part of a file"
          description="west, south, east, north in degrees"
          placeholder="13.34, 52.51, 13.36, 52.52"
          data-testid="bbox"
          value={wishes.bbox}
          onChange={(event) => onWishes({ ...wishes, bbox: event.currentTarget.value })}
        />
        <Checkbox
          size="xs"
          mt="xs"
          label="Replace a map of the same name"
          description="its corrections are kept and applied again"
          data-testid="replace"
          checked={wishes.replace}
          onChange={(event) => onWishes({ ...wishes, replace: event.currentTarget.checked })}
        />
      </div>
    </section>
  );
}

const INPUT = { "data-testid": "file-input", "aria-label": "Map file" } as never;

type DownloadProps = Pick<Props, "wishes" | "onStarted" | "field">;

/** What was typed stays when it is refused. */
function DownloadForm({ wishes, onStarted, field }: DownloadProps) {
  const [text, setText] = useState("");
  const download = useDownload();
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const name = wishes.name.trim();
    download.mutate({ ...placeOrBox(text), ...(name ? { name } : {}), replace: wishes.replace }, { onSuccess: onStarted });
  };
  return (
    <form className={classes.way} onSubmit={submit}>
      <h2>From OpenStreetMap</h2>
      <Text size="xs" c="dimmed">
        Downloads a place by its name, or a box: west, south, east, north in degrees.
      </Text>
      <div className={classes.line}>
        <TextInput
          ref={field}
          size="xs"
          style={{ flex: 1 }}
          aria-label="Place or box"
          placeholder="Großer Stern, Berlin (/)"
          data-testid="place"
          leftSection={<Icon name="search" size={14} />}
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
        />
        <Tooltip label="Type a place first" disabled={text.trim() !== ""}>
          <span>
            <Button
              type="submit"
              size="xs"
              variant="default"
              data-testid="download"
              disabled={text.trim() === ""}
              loading={download.isPending}
            >
              Download
            </Button>
          </span>
        </Tooltip>
      </div>
      {download.error ? (
        <div role="alert" className={classes.problem}>
          {download.error.message}
          <ProblemList problems={(download.error as { problems?: Problem[] }).problems ?? []} />
        </div>
      ) : null}
    </form>
  );
}
