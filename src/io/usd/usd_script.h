// Runs share/python/usd_cameras.py, which reads and writes USD through USD's own library. The script is compiled in, so
// that it is found wherever the tools are installed.
#pragma once

#include <string>
#include <vector>

namespace sparselens {

// The contents of share/python/usd_cameras.py.
const char *usd_script();

// Runs the script with these words and `given` as standard input, and returns its standard output. The program is
// python3, or that which the environment variable SPARSELENS_USD_PYTHON names. Throws Error if it fails, with the last
// line that the script wrote; other messages begin with `file`.
std::string run_usd_script(const std::vector<std::string> &words, const std::string &given,
                           const std::string &file);

} // namespace sparselens
