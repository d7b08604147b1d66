// The answer of dof-view, to the page or in a pipe, to a request that failed.
#pragma once

#include "base/error.h"
#include "harness/one_line.h"

#include <exception>
#include <new>
#include <string>

namespace sparselens {

struct Refusal {
    int status; // as in HTTP: 400 if the request is wrong, 500 if it could not be done
    std::string why;
};

// Describes the exception that is being handled: call it in a catch block, for exceptions derived from std::exception.
inline Refusal refusal_of_exception() {
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
