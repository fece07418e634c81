/** A dotted path that may break after its dots and nowhere else. */

import { Fragment } from "react";

export function Path({ path }: { path: string }) {
  return path.split(".").map((part, index) => (
    <Fragment key={index}>
      {index > 0 ? (
        <>
          .<wbr />
        </>
      ) : null}
      {part}
    </Fragment>
  ));
}
