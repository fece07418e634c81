/** A file may be dropped anywhere on the view. */

import { useEffect, useRef, useState } from "react";
import classes from "./Drop.module.css";
import { Icon } from "./Icon";

interface Props {
  onFiles: (files: File[]) => void;
  /** What would be done with a file that is dropped. */
  children: string;
}

/** Shows that a file would be taken while it is held over the page, and takes what is dropped. */
export function DropAnywhere({ onFiles, children }: Props) {
  const [over, setOver] = useState(false);
  const latest = useRef(onFiles);
  latest.current = onFiles;
  useEffect(() => {
    const ended = new AbortController();
    const { signal } = ended;
    const holdsFiles = ({ dataTransfer }: DragEvent) => dataTransfer?.types.includes("Files") ?? false;
    const hold = (event: DragEvent) => {
      if (!holdsFiles(event)) return;
      // Without this the browser would open the file in place of the page.
      event.preventDefault();
      setOver(true);
    };
    window.addEventListener("dragenter", hold, { signal });
    window.addEventListener("dragover", hold, { signal });
    window.addEventListener("dragleave", (event) => event.relatedTarget === null && setOver(false), { signal });
    window.addEventListener(
      "drop",
      (event) => {
        if (!holdsFiles(event)) return;
        event.preventDefault();
        setOver(false);
        latest.current([...(event.dataTransfer?.files ?? [])]);
      },
      { signal },
    );
    return () => ended.abort();
  }, []);
  return over ? (
    <div className={classes.veil} data-testid="drop-veil">
      <Icon name="upload" size={34} />
      {children}
    </div>
  ) : null;
}
