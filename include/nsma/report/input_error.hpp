#pragma once

#include <stdexcept>

namespace nsma {

/// A scene, flag or folder the user can mend: the message is one line with what, where, expected and got.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// There is no gnuplot: charts cannot be drawn, all else can be done.
class NoGnuplot : public InputError {
public:
    using InputError::InputError;
};

}  // namespace nsma
