#include "hdf5/hdf5_handle.h"

#include <cstdlib>
#include <mutex>
#include <string_view>

namespace mssim {
namespace {

struct Reason {
  std::string text;
  int error_number = 0;
};

/// Keeps the innermost entry of the error stack. Where a system call failed, its text reads
/// "...: ..., errno = 28, error message = 'No space left on device', ...".
herr_t note_innermost(unsigned depth, const H5E_error2_t* entry, void* reason_) {
  if (depth > 0) return 0;
  Reason& reason = *static_cast<Reason*>(reason_);
  reason.text = entry->desc ? entry->desc : "";
  constexpr std::string_view number_key = "errno = ", message_key = "error message = '";
  if (const std::size_t at = reason.text.find(number_key); at != std::string::npos)
    reason.error_number = std::atoi(reason.text.c_str() + at + number_key.size());
  if (const std::size_t at = reason.text.find(message_key); at != std::string::npos) {
    const std::size_t start = at + message_key.size();
    reason.text = reason.text.substr(start, reason.text.find('\'', start) - start);
  }
  return 0;
}

}  // namespace

void prepare_hdf5() {
  static std::once_flag once;
  std::call_once(once, [] {
    // HDF5 reads it once, before anything else. A file under way is locked by its AtomicFile, which HDF5's
    // own locks would take for another program's.
    ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  });
}

void throw_hdf5_error(const std::string& action) {
  Reason reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_innermost, &reason);
  if (reason.text.empty()) reason.text = "HDF5 gave no reason";
  throw Hdf5Error(action, reason.text, reason.error_number);
}

}  // namespace mssim
