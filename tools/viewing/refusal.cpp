#include "viewing/refusal.h"

#include "base/error.h"
#include "harness/one_line.h"

#include <exception>
#include <new>

namespace sparselens {

Refusal refusal_of_exception() {
    try {
        throw;
    } catch (const UsageError &error) {
        return {400, with_options(error.what())};
    } catch (const std::bad_alloc &) {
        return {500, "there is not enough memory for this"};
    } catch (const std::exception &error) {
        return {500, with_options(error.what())};
    }
}

} // namespace sparselens
