// The words of notices: one table for all interfaces. Parameters stand between backquotes, as in errors (base/error.h).
#pragma once

#include "chain/notices.h"

namespace sparselens {

enum class NoticeLevel {
    note, // shown on request
    warning,
    once, // a warning that need not be repeated for each frame of an animation
};

NoticeLevel level_of(const Notice &notice);
std::string words_of(const Notice &notice);

} // namespace sparselens
