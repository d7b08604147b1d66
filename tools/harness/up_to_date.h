// Whether a frame needs no work (-u).
#pragma once

#include "harness/named_files.h"

namespace sparselens {

// Whether every output that the options name exists, is complete, and is not older than any file that is read. Other
// options are not compared: another f-number needs another output name, or no -u.
bool is_up_to_date(const NamedFiles &files);

} // namespace sparselens
