// What a call complains of.
#pragma once

#include <gtest/gtest.h>

#include <exception>
#include <string>

namespace arthronaut::test {

// The message of the exception that `call` throws, or a failure that says what happened instead.
template <typename Exception, typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Exception& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another exception: " << error.what();
    return "";
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

}  // namespace arthronaut::test
