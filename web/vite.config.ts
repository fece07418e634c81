import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";

/** Where `npm run dev` finds the studio server. */
const server = process.env.STUDIO_SERVER ?? "http://127.0.0.1:8000";
const relay = { target: server, changeOrigin: true, ws: true, rewriteWsOrigin: true };

/** The first that know light-dark(); for older ones it would be rewritten in a way that does not follow our theme. */
const BROWSERS = ["chrome123", "edge123", "firefox120", "safari17.5"];

export default defineConfig({
  // Absolute, so that a nested deep link finds its assets.
  base: "/",
  plugins: [react()],
  build: {
    outDir: process.env.STUDIO_WEB_OUT ?? "../studio/_web",
    emptyOutDir: true,
    chunkSizeWarningLimit: 900,
    cssTarget: BROWSERS,
  },
  server: { proxy: { "/api": relay, "/scene": relay } },
  test: {
    environment: "happy-dom",
    include: ["src/**/*.test.{ts,tsx}"],
    setupFiles: ["src/test/setup.ts"],
    // Nothing is proven by it: a machine may be slow, and busy.
    testTimeout: 300_000,
    hookTimeout: 300_000,
  },
});
