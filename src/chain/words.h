// The words of notices: one table for all faces. Parameters stand between backquotes, as in errors (base/error.h).
#pragma once

#include "chain/notices.h"

namespace sparselens {

enum class NoticeLevel {
    note, // for those who ask
    warning,
    once, // a warning that need not be repeated for each frame
};

NoticeLevel level_of(const Notice &notice);
std::string words_of(const Notice &notice);

} // namespace sparselens
