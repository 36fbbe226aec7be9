#pragma once

#include <stdexcept>

namespace nsma {

/// A scene, flag or folder the user can mend: the message is one line with what, where, expected and got.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace nsma
