import { defineConfig } from "vitest/config";

export default defineConfig({
  // Threads begin sooner than processes, of which there would be one for each file.
  test: { include: ["test/unit/**/*.test.ts"], pool: "threads", maxWorkers: 2 },
});
