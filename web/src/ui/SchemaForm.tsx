/** The parameter form: sections with one row per value, its unit, and what is wrong with it. */

import {
  Accordion,
  ActionIcon,
  Autocomplete,
  Badge,
  NativeSelect,
  Switch,
  Text,
  TextInput,
  Tooltip,
  UnstyledButton,
  VisuallyHidden,
} from "@mantine/core";
import { useId, useState } from "react";
import {
  changedIn,
  type Exchange,
  type Field,
  fieldsOf,
  type Section,
} from "../model/form";
import type { Json, Problem } from "../model/run";
import { formatValue, words } from "../model/units";
import { Icon } from "./Icon";
import { NumberEntry } from "./NumberEntry";
import { ProblemText } from "./Problems";
import classes from "./SchemaForm.module.css";

export interface Actions {
  onChange: (field: Field, value: Json) => void;
  onExchange: (exchange: Exchange, name: string) => void;
}

interface Props extends Actions {
  sections: readonly Section[];
  problems: ReadonlyMap<string, readonly Problem[]>;
  /** Paths of the sections that stand open. */
  open: string[];
  /** Show everything, as while searching. */
  expanded: boolean;
  onOpen: (open: string[]) => void;
}

type Shared = Pick<Props, "problems" | "expanded" | "onChange" | "onExchange">;

export function SchemaForm({ sections, open, onOpen, ...shared }: Props) {
  return (
    <Accordion
      multiple
      value={open}
      onChange={onOpen}
      chevronPosition="left"
      variant="default"
      transitionDuration={0}
      styles={ACCORDION}
    >
      {sections.map((section) => (
        <Accordion.Item key={section.path} value={section.path}>
          <Accordion.Control>
            {section.title} <Marks section={section} problems={shared.problems} />
          </Accordion.Control>
          <Accordion.Panel>
            <SectionBody section={section} {...shared} />
          </Accordion.Panel>
        </Accordion.Item>
      ))}
    </Accordion>
  );
}

const ACCORDION = {
  control: { paddingLeft: 10, paddingRight: 8, minHeight: 34 },
  label: { paddingTop: 6, paddingBottom: 6, fontWeight: 600, fontSize: 13 },
  chevron: { marginRight: 6, width: 14 },
  content: { padding: "0 4px 8px 4px" },
};

/** How much below this section was changed, and whether something is wrong there. */
function Marks({ section, problems }: { section: Section; problems: Props["problems"] }) {
  const changed = changedIn(section);
  const wrong = [...problems.keys()].filter(
    (path) => path !== "" && path.startsWith(`${section.path}.`),
  ).length;
  return (
    <>
      {changed > 0 ? (
        <Badge size="xs" variant="light" tt="none">
          {changed} changed
        </Badge>
      ) : null}
      {wrong > 0 ? (
        <Badge size="xs" color="red" variant="light" tt="none" ml={4}>
          {wrong} wrong
        </Badge>
      ) : null}
    </>
  );
}

function SectionBody({ section, ...shared }: { section: Section } & Shared) {
  const { exchange, fields, sections } = section;
  return (
    <>
      {exchange ? <ExchangeRow exchange={exchange} {...shared} /> : null}
      {fields.map((field) => (
        <FieldRow
          key={field.path}
          field={field}
          problems={shared.problems.get(field.path) ?? []}
          onChange={shared.onChange}
        />
      ))}
      {sections.map((inner) => (
        <InnerSection key={inner.path} section={inner} {...shared} />
      ))}
    </>
  );
}

/** Long parts, such as a whole vehicle, stand closed until they are wanted; an application, which is tuned, is not one. */
const SHORT = 20;

function InnerSection({ section, ...shared }: { section: Section } & Shared) {
  const [toggled, setToggled] = useState<boolean>();
  const open = shared.expanded || (toggled ?? fieldsOf([section]).length <= SHORT);
  return (
    <section className={classes.inner} aria-label={section.title}>
      <UnstyledButton className={classes.heading} aria-expanded={open} onClick={() => setToggled(!open)}>
        <Icon name={open ? "down" : "right"} size={12} />
        {section.title} <Marks section={section} problems={shared.problems} />
      </UnstyledButton>
      {open ? (
        <div className={classes.nested}>
          <SectionBody section={section} {...shared} />
        </div>
      ) : null}
    </section>
  );
}

function ExchangeRow({ exchange, onExchange, problems }: { exchange: Exchange } & Shared) {
  const id = useId();
  const { path, sort, initial, value, description, choices } = exchange;
  const changed = value !== initial;
  return (
    <div className={classes.row} data-wide data-changed={changed || undefined}>
      <Label id={id} text={words(sort)} description={description} path={path} />
      <NativeSelect
        id={id}
        size="xs"
        data-testid={sort === "application" ? `application-${path.split(".")[1]}` : `param-${path}`}
        value={value}
        onChange={(event) => onExchange(exchange, event.currentTarget.value)}
        data={choices.map(({ name, title }) => ({ value: name, label: title }))}
      />
      {changed ? (
        <Reset label={words(sort)} initial={initial} onReset={() => onExchange(exchange, initial)} />
      ) : null}
      <Wrong problems={problems.get(path) ?? []} />
    </div>
  );
}

interface RowProps {
  field: Field;
  problems: readonly Problem[];
  onChange: Actions["onChange"];
}

function FieldRow({ field, problems, onChange }: RowProps) {
  const id = useId();
  const long = String(field.initial ?? "").length > 12 || field.suggestions.length > 0;
  const wide = field.kind === "list" || (field.kind === "text" && long);
  return (
    <div
      className={classes.row}
      data-wide={wide || undefined}
      data-changed={field.changed || undefined}
      data-default={field.isDefault || undefined}
    >
      <Label
        id={id}
        text={field.label}
        description={field.description}
        path={field.path}
        limits={field.allowed}
        isDefault={field.isDefault}
      />
      <Control
        id={id}
        field={field}
        invalid={problems.length > 0}
        onChange={(value) => onChange(field, value)}
      />
      {wide ? null : <span className={classes.unit}>{field.unit}</span>}
      {field.changed ? (
        <Reset label={field.label} initial={field.initial} onReset={() => onChange(field, field.initial)} />
      ) : (
        <span />
      )}
      <Wrong problems={problems} />
    </div>
  );
}

function Wrong({ problems }: { problems: readonly Problem[] }) {
  if (problems.length === 0) return null;
  return (
    <div className={classes.problem} role="alert">
      {problems.map((problem) => (
        <ProblemText key={problem.what} problem={problem} withPlace={false} />
      ))}
    </div>
  );
}

interface LabelProps {
  id: string;
  text: string;
  description: string;
  path: string;
  limits?: string;
  isDefault?: boolean;
}

function Label({ id, text, description, path, limits: allowed = "", isDefault = false }: LabelProps) {
  const help = (
    <>
      {description ? <Text size="xs">{description}</Text> : null}
      {allowed ? <Text size="xs">Allowed: {allowed}</Text> : null}
      {isDefault ? <Text size="xs">Default: the scenario's file does not set it.</Text> : null}
      <Text size="xs" opacity={0.7}>
        {path}
      </Text>
    </>
  );
  return (
    <Tooltip label={help} multiline maw={300} position="right" openDelay={250}>
      <label htmlFor={id} className={classes.label} data-described={description !== "" || undefined}>
        {text}
        {isDefault ? <VisuallyHidden> (default)</VisuallyHidden> : null}
      </label>
    </Tooltip>
  );
}

function Reset({ label, initial, onReset }: { label: string; initial: Json; onReset: () => void }) {
  return (
    <Tooltip label={`Back to ${formatValue(initial)}`}>
      <ActionIcon
        size="sm"
        variant="subtle"
        aria-label={`Reset ${label} to ${formatValue(initial)}`}
        onClick={onReset}
      >
        <Icon name="reset" size={14} />
      </ActionIcon>
    </Tooltip>
  );
}

interface ControlProps {
  id: string;
  field: Field;
  invalid: boolean;
  onChange: (value: Json) => void;
}

function Control({ id, field, invalid, onChange }: ControlProps) {
  const shared = { id, size: "xs" as const, error: invalid, "data-testid": `param-${field.path}` };
  switch (field.kind) {
    case "boolean":
      return (
        <Switch
          {...shared}
          error={undefined}
          checked={field.value === true}
          onChange={(event) => onChange(event.currentTarget.checked)}
        />
      );
    case "colour":
      return (
        <TextInput
          {...shared}
          type="color"
          value={String(field.value)}
          onChange={(event) => onChange(event.currentTarget.value)}
        />
      );
    case "choice":
      return (
        <NativeSelect
          {...shared}
          value={String(field.value ?? "")}
          data={field.value === null || field.nullable ? ["", ...field.choices] : field.choices}
          onChange={({ currentTarget: { value } }) => onChange(value === "" && field.nullable ? null : value)}
        />
      );
    case "number":
    case "integer":
      return <NumberControl shared={shared} field={field} onChange={onChange} />;
    case "list":
      return <ListControl shared={shared} field={field} onChange={onChange} />;
    default:
      return field.suggestions.length > 0 ? (
        <Autocomplete
          {...shared}
          value={String(field.value ?? "")}
          data={field.suggestions}
          filter={({ options }) => options}
          onChange={onChange}
        />
      ) : (
        <TextInput
          {...shared}
          value={String(field.value ?? "")}
          onChange={(event) => onChange(event.currentTarget.value)}
        />
      );
  }
}

interface TypedControl {
  shared: { id: string; size: "xs"; error: boolean; "data-testid": string };
  field: Field;
  onChange: (value: Json) => void;
}

/** A number may leave its range while it is typed: the server says what is wrong, nothing is silently clamped. */
function NumberControl({ shared, field, onChange }: TypedControl) {
  const { minimum, maximum, value, kind, initial } = field;
  const outside =
    typeof value === "number" &&
    ((minimum !== undefined && value < minimum) || (maximum !== undefined && value > maximum));
  return (
    <NumberEntry
      {...shared}
      error={shared.error || outside}
      value={typeof value === "number" ? value : ""}
      whole={kind === "integer"}
      step={stepFor(field)}
      onNumber={onChange}
      onEmpty={() => onChange(field.nullable ? null : initial)}
      placeholder={field.nullable ? "not set" : undefined}
      {...(minimum === undefined ? {} : { min: minimum })}
      {...(maximum === undefined ? {} : { max: maximum })}
    />
  );
}

/** About a twentieth of the value, as 1, 2 or 5 times a power of ten. */
function stepFor({ kind, initial }: Field): number {
  const size = Math.abs(Number(initial)) / 20;
  if (!(size > 0)) return kind === "integer" ? 1 : 0.1;
  const power = 10 ** Math.floor(Math.log10(size));
  const step = [5, 2, 1].map((digit) => digit * power).find((candidate) => candidate <= size * 1.01) ?? power;
  return kind === "integer" ? Math.max(1, Math.round(step)) : Number(step.toPrecision(1));
}

function ListControl({ shared, field, onChange }: TypedControl) {
  const items = Array.isArray(field.value) ? field.value : [];
  const numeric = items.length > 0 && items.every((item) => typeof item === "number");
  const [doubt, setDoubt] = useState("");
  const take = (text: string) => {
    // One number, or two?
    const [unclear] = numeric ? (text.match(/\d,\d+/) ?? []) : [];
    setDoubt(unclear ? `${unclear} is not read: write decimals with a point, and a blank behind the comma between two numbers` : "");
    if (!unclear) onChange(read(text));
  };
  const read = (text: string): Json => {
    const words = text
      .split(",")
      .map((word) => word.trim())
      .filter(Boolean);
    return numeric && words.every((word) => Number.isFinite(Number(word))) ? words.map(Number) : words;
  };
  return (
    <TextInput
      {...shared}
      key={JSON.stringify(items)}
      error={doubt || shared.error}
      title={items.map(String).join(", ")}
      defaultValue={items
        .map((item) => (typeof item === "object" ? JSON.stringify(item) : String(item)))
        .join(", ")}
      onBlur={(event) => take(event.currentTarget.value)}
    />
  );
}
