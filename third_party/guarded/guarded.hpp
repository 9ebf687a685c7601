/* SPDX-License-Identifier: Apache-2.0 */
/* guarded.hpp -- no exception crosses into C, and none loses its message on the way; for the
 * wrappers' .cpp alone. */
#pragma once
#include <exception>
#include <new>
#include <string>

#include "base/error.h"

/* What the body returns. False, where it throws: the error says what was being done, and why;
 * of `code`, or out of memory. told: makes one line of the library's words; nullptr: it is one. */
template <typename Body>
bool guarded(Error *err, ErrorCode code, const char *doing, Body body,
             std::string (*told)(std::string) = nullptr) noexcept
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return error_set(err, ERROR_MEMORY, "%s: out of memory", doing);
    } catch (const std::exception &e) {
        return error_set(err, code, "%s: %s", doing, told ? told(e.what()).c_str() : e.what());
    } catch (...) {
        return error_set(err, code, "%s: unknown C++ exception", doing);
    }
}
