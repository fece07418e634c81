import { act } from "react";
import { createRoot } from "react-dom/client";
import { expect, it } from "vitest";
import { useZoom, type Zoom } from "./zoom";

it("belongs to one run, and is not chosen by a hand that shakes", () => {
  let zoom: Zoom = { span: undefined, choose: () => undefined };
  function Charts({ run }: { run: number }) {
    zoom = useZoom(run);
    return null;
  }
  const root = createRoot(document.createElement("div"));
  const show = (run: number) => act(() => root.render(<Charts run={run} />));
  const choose = (span: Zoom["span"]) => act(() => zoom.choose(span));
  show(1);
  choose([2, 3]);
  choose([2, 2.01]);
  show(1);
  expect(zoom.span).toEqual([2, 3]);
  show(2);
  expect(zoom.span).toBeUndefined();
  choose([4, 5]);
  choose(undefined);
  expect(zoom.span).toBeUndefined();
  act(() => root.unmount());
});
