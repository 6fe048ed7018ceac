// node validate_gltf.mjs FILE...   Khronos' validator on GLB files: one line a message and one a file.
// Exit code 0: no errors, warnings or degenerate triangles; 1: some; 77: the validator is not installed.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { homedir } from "node:os";
import { join } from "node:path";

const cache = process.env.XDG_CACHE_HOME || join(homedir(), ".cache");
let validator;
try {
  validator = createRequire(join(cache, "carve", "npm", "node_modules", "x.js"))("gltf-validator");
} catch {
  console.log("gltf-validator is not installed; tests/install_npm does it");
  process.exit(77);
}

const severities = ["error", "warning", "info", "hint"];
let failed = false;
for (const path of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), { uri: path, format: "glb" });
  for (const message of report.issues.messages) {
    const bad = message.severity < 2 || message.code.includes("DEGENERATE");
    failed ||= bad;
    console.log(`${path}: ${severities[message.severity]} ${message.code} ${message.pointer ?? ""}: ${message.message}`);
  }
  const { numErrors, numWarnings, numInfos } = report.issues;
  const { totalVertexCount, totalTriangleCount } = report.info ?? {};
  console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ` +
              `${totalVertexCount} vertices, ${totalTriangleCount} triangles`);
}
process.exit(failed ? 1 : 0);
