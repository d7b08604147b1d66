// The answer of dof-view, to the page or in a pipe, to a request that failed.
#pragma once

#include <string>

namespace sparselens {

struct Refusal {
    int status; // as in HTTP: 400 if the request is wrong, 500 if it could not be done
    std::string why;
};

// Describes the exception that is being handled: call it in a catch block, for exceptions derived from std::exception.
Refusal refusal_of_exception();

} // namespace sparselens
