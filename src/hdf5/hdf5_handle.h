#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace mssim {

/// Thrown when an HDF5 call fails; what() is the reason from HDF5's error stack.
struct Hdf5Error : std::runtime_error {
  Hdf5Error(const std::string& action_, const std::string& reason, int error_number_)
      : std::runtime_error(reason), action(action_), error_number(error_number_) {}
  std::string action;  ///< what was being done, for example "creating /h5md"
  int error_number;    ///< the errno that HDF5 noted, 0 when it noted none
};

/// Call before any other HDF5 function: keeps HDF5 from locking files, which their writers do, from printing
/// its error stack, and from flushing files at exit, where it crashes when a file could not be written.
void prepare_hdf5();

/// Throws the Hdf5Error of the HDF5 call that has just failed.
[[noreturn]] void throw_hdf5_error(const std::string& action);

/// Passes on the result of an HDF5 call, an identifier or a status; throws Hdf5Error when it is negative.
template <class Result>
Result checked(Result result, const std::string& action) {
  if (result < 0) throw_hdf5_error(action);
  return result;
}

/// Owns an HDF5 identifier of one kind.
template <herr_t (*close_identifier)(hid_t)>
class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  /// Takes what an HDF5 call returned; throws Hdf5Error when the call failed.
  Hdf5Handle(hid_t identifier, const std::string& action) : identifier_(checked(identifier, action)) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : identifier_(other.release()) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(identifier_, other.identifier_);
    return *this;
  }
  ~Hdf5Handle() {
    if (identifier_ >= 0) close_identifier(identifier_);
  }
  hid_t get() const { return identifier_; }
  /// Closes now; throws Hdf5Error when that fails, as it does when something could not be written.
  void close(const std::string& action) { checked(close_identifier(release()), action); }
  /// Gives the identifier up without closing it.
  hid_t release() { return std::exchange(identifier_, -1); }

 private:
  hid_t identifier_ = -1;
};

using Hdf5File = Hdf5Handle<H5Fclose>;
using Hdf5Group = Hdf5Handle<H5Gclose>;
using Hdf5Dataset = Hdf5Handle<H5Dclose>;
using Hdf5Space = Hdf5Handle<H5Sclose>;
using Hdf5Type = Hdf5Handle<H5Tclose>;
using Hdf5Attribute = Hdf5Handle<H5Aclose>;
using Hdf5Properties = Hdf5Handle<H5Pclose>;

}  // namespace mssim
