// Forward declarations of the CLI11 classes that the tools add options to. CLI11 is one large header, and every file
// that includes it takes 3 s longer to compile (GCC 12). So only files that declare or read options include it.
#pragma once

namespace CLI {
class App;
class Validator;
} // namespace CLI
