import { MantineProvider } from "@mantine/core";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { RouterProvider } from "@tanstack/react-router";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import "./app/styles";
import { Refusal } from "./api/client";
import { router } from "./app/router";
import { legible, theme } from "./app/theme";

const client = new QueryClient({
  // A refusal of the server stays one; only a missing answer is worth asking again.
  defaultOptions: {
    queries: { retry: (count, error) => !(error instanceof Refusal) && count < 2, staleTime: 1000 },
  },
});

createRoot(document.getElementById("root") as HTMLElement).render(
  <StrictMode>
    <MantineProvider theme={theme} cssVariablesResolver={legible} defaultColorScheme="auto">
      <QueryClientProvider client={client}>
        <RouterProvider router={router} />
      </QueryClientProvider>
    </MantineProvider>
  </StrictMode>,
);
