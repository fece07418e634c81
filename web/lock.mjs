// `npm run lock`: writes package-lock.json afresh, for all platforms and without any address.
//
// It is made in an empty folder, because npm leaves out the packages of other platforms when node_modules is there.
// .npmrc leaves out the registry's addresses; those of sponsors go here.
import { execSync } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const folder = mkdtempSync(join(tmpdir(), "lock-"));
for (const name of ["package.json", ".npmrc"]) copyFileSync(name, join(folder, name));
execSync("npm install --package-lock-only --ignore-scripts", { cwd: folder, stdio: "inherit" });
const lock = JSON.parse(readFileSync(join(folder, "package-lock.json"), "utf8"));
rmSync(folder, { recursive: true });
for (const entry of Object.values(lock.packages)) {
  delete entry.funding;
  delete entry.resolved;
}
writeFileSync("package-lock.json", `${JSON.stringify(lock, null, 2)}\n`);
