/** The server's words for channels and metrics; none until it has answered. */

import { useQuery } from "@tanstack/react-query";
import type { Server } from "../model/run";
import { glossary } from "./queries";

const NOTHING: Server["Glossary"] = { channels: [], metrics: [], alike: 0 };

export const useGlossary = (): Server["Glossary"] => useQuery(glossary).data ?? NOTHING;
