/** A note as it is read: a little of Markdown, its times as buttons that lead there. */

import { Anchor, Code, Text } from "@mantine/core";
import { blocksOf, type Block, type Piece } from "../model/note";

interface Props {
  note: string;
  /** Where a time leads; without it times are text. */
  onSeek?: ((time: number) => void) | undefined;
}

export function Note({ note, onSeek }: Props) {
  return blocksOf(note).map((block, place) => <Part key={place} block={block} onSeek={onSeek} />);
}

function Part({ block, onSeek }: { block: Block } & Pick<Props, "onSeek">) {
  if (block.is === "code") return <Code block>{block.text}</Code>;
  if (block.is === "list") {
    const List = block.ordered ? "ol" : "ul";
    return (
      <List style={{ margin: "2px 0", paddingInlineStart: 20, fontSize: 14 }}>
        {block.items.map((pieces, place) => (
          <li key={place}>
            <Pieces pieces={pieces} onSeek={onSeek} />
          </li>
        ))}
      </List>
    );
  }
  return (
    <Text size="sm" component="p" my={2} fw={block.is === "heading" ? 700 : undefined} style={{ overflowWrap: "anywhere" }}>
      <Pieces pieces={block.pieces} onSeek={onSeek} />
    </Text>
  );
}

const Pieces = ({ pieces, onSeek }: { pieces: readonly Piece[] } & Pick<Props, "onSeek">) =>
  pieces.map((piece, place) => <One key={place} piece={piece} onSeek={onSeek} />);

function One({ piece, onSeek }: { piece: Piece } & Pick<Props, "onSeek">) {
  switch (piece.is) {
    case "strong":
      return <b>{piece.text}</b>;
    case "emphasis":
      return <em>{piece.text}</em>;
    case "code":
      return <Code>{piece.text}</Code>;
    case "link":
      return (
        <Anchor href={piece.href} target="_blank" rel="noreferrer noopener" inherit>
          {piece.text}
        </Anchor>
      );
    case "time":
      return onSeek ? (
        <Anchor component="button" type="button" inherit title="Go there" onClick={() => onSeek(piece.time)}>
          {piece.text}
        </Anchor>
      ) : (
        piece.text
      );
    default:
      return piece.text;
  }
}
