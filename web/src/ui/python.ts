/** Python in the text editor, with what the server's vocabulary completes. */

import { autocompletion, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { python } from "@codemirror/lang-python";
import { indentUnit } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { complete, type Vocabulary } from "../model/completion";

/** `vocabulary` is asked at every completion: it may come later than the editor. */
export const pythonText = (vocabulary: () => Vocabulary | undefined): Extension => [
  python(),
  indentUnit.of("    "),
  autocompletion({ override: [(context) => completed(context, vocabulary())], icons: false }),
];

function completed({ state, pos, explicit }: CompletionContext, vocabulary: Vocabulary | undefined): CompletionResult | null {
  const found = vocabulary ? complete(state.doc.toString(), pos, vocabulary) : null;
  // A name that stands alone is completed from its second letter on, or when somebody asks.
  const isBelow = found ? state.sliceDoc(found.from - 1, found.from) === "." : false;
  if (!found || (!explicit && !isBelow && pos - found.from < 2)) return null;
  const options = found.offers.map(({ label, detail, info }) => (info ? { label, detail, info } : { label, detail }));
  return { from: found.from, options, validFor: /^\w*$/ };
}
