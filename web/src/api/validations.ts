/** Validation projects: what the page reads of them, and what it asks the server to do with them. */

import { queryOptions, useMutation, useQueryClient } from "@tanstack/react-query";
import type { Server } from "../model/run";
import { goesOn, type Kinds, type Operation, type ProjectJob } from "../model/validation";
import { answer, client } from "./client";

export const validationKinds = queryOptions({
  queryKey: ["validation kinds"],
  queryFn: () => answer(client.GET("/api/validation-kinds")) as Promise<Kinds>,
  staleTime: Number.POSITIVE_INFINITY,
});

export const validations = queryOptions({ queryKey: ["validations"], queryFn: () => answer(client.GET("/api/validations")) });

export const validation = (project: string) =>
  queryOptions({
    queryKey: ["validation", project],
    queryFn: () => answer(client.GET("/api/validations/{project}", { params: { path: { project } } })),
  });

export const iteration = (number: number | undefined) =>
  queryOptions({
    queryKey: ["iteration", number],
    queryFn: () => answer(client.GET("/api/iterations/{iteration}", { params: { path: { iteration: number ?? 0 } } })),
    enabled: number !== undefined,
    staleTime: Number.POSITIVE_INFINITY,
  });

export const courses = (project: string, number: number) =>
  queryOptions({
    queryKey: ["courses", project, number],
    queryFn: () =>
      answer(
        client.GET("/api/validations/{project}/iterations/{iteration}/courses", { params: { path: { project, iteration: number } } }),
      ),
    staleTime: Number.POSITIVE_INFINITY,
  });

/** Jobs of this server, newest first; asked again quickly while one goes on. */
export const projectJobs = queryOptions({
  queryKey: ["validation jobs"],
  queryFn: () => answer(client.GET("/api/validation-jobs")),
  refetchInterval: ({ state }) => (state.data?.some(goesOn) ? 300 : false),
});

/** One job with what came out. */
export const projectJob = (id: number | undefined) =>
  queryOptions({
    queryKey: ["validation job", id],
    queryFn: () => answer(client.GET("/api/validation-jobs/{job}", { params: { path: { job: id ?? 0 } } })),
    enabled: id !== undefined,
    refetchInterval: ({ state }) => (goesOn(state.data) ? 300 : false),
  });

export const reportOf = (project: string, number: number): string =>
  `/api/validations/${encodeURIComponent(project)}/iterations/${number}/report`;

export const paperOf = (project: string, number: number): string => `${reportOf(project, number)}.pdf`;

/** Where the vehicle file of a validation is downloaded from. */
export const vehicleOf = (project: string, number: number): string =>
  `/api/validations/${encodeURIComponent(project)}/iterations/${number}/vehicle`;

/** Everything that may say something else when a project has changed, or a job is over. */
export function useRefreshed(project: string) {
  const kept = useQueryClient();
  return () => Promise.all([["validation", project], ["validations"]].map((queryKey) => kept.invalidateQueries({ queryKey })));
}

export function useNewProject() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: (body: Server["NewProject"]) => answer(client.POST("/api/validations", { body })),
    onSuccess: () => kept.invalidateQueries({ queryKey: ["validations"] }),
  });
}

/** Start a job and let the list of jobs know it at once. */
function useStart<What>(start: (what: What) => Promise<ProjectJob>) {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: start,
    onSuccess: (job) => {
      kept.setQueryData(projectJobs.queryKey, (jobs) => [job, ...(jobs ?? []).filter(({ id }) => id !== job.id)]);
      return kept.invalidateQueries({ queryKey: projectJobs.queryKey });
    },
  });
}

export const useSample = () =>
  useStart((name: string) => answer(client.POST("/api/validations/sample", { body: { name, vehicle: "bmw_320i" } })));

export const useJob = (project: string) =>
  useStart((body: Partial<Server["NewJob"]> & Pick<Server["NewJob"], "task">) =>
    answer(client.POST("/api/validations/{project}/jobs", { params: { path: { project } }, body: { afresh: false, ...body } })),
  );

export const useCancelJob = () =>
  useStart((job: number) => answer(client.DELETE("/api/validation-jobs/{job}", { params: { path: { job } } })));

/** Change a project; somebody else's change meanwhile is told. */
export function usePatch(project: string, digest: string) {
  const refreshed = useRefreshed(project);
  return useMutation({
    mutationFn: (patch: Operation[]) =>
      answer(
        client.PATCH("/api/validations/{project}", {
          params: { path: { project } },
          body: patch as Server["Operation"][],
          headers: { "Content-Type": "application/json-patch+json", "If-Match": `"${digest}"` },
        }),
      ),
    onSettled: refreshed,
  });
}

export function usePutText(project: string) {
  const refreshed = useRefreshed(project);
  return useMutation({
    mutationFn: ({ text, digest }: { text: string; digest: string }) =>
      answer(
        client.PUT("/api/validations/{project}/text", {
          params: { path: { project } },
          body: text,
          bodySerializer: (body: string) => body,
          headers: { "Content-Type": "application/yaml", "If-Match": `"${digest}"` },
        }),
      ),
    onSuccess: refreshed,
  });
}

/** A file for the folder of the project. */
export function usePutFile(project: string) {
  const refreshed = useRefreshed(project);
  return useMutation({
    mutationFn: ({ name, content, replace = false }: { name: string; content: Blob | string; replace?: boolean }) =>
      answer(
        client.PUT("/api/validations/{project}/files/{name}", {
          params: { path: { project, name }, query: { replace } },
          body: content as string,
          bodySerializer: (body: unknown) => body as BodyInit,
          headers: { "Content-Type": "application/octet-stream" },
        }),
      ),
    onSuccess: refreshed,
  });
}

export function useDeleteFile(project: string) {
  const refreshed = useRefreshed(project);
  return useMutation({
    mutationFn: (name: string) =>
      answer(client.DELETE("/api/validations/{project}/files/{name}", { params: { path: { project, name } } })),
    onSuccess: refreshed,
  });
}
