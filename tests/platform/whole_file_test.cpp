#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "platform/files.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class WholeFile : public TemporaryFolderTest {
 protected:
  static std::string refusal_of(const std::filesystem::path& file, std::size_t most_bytes = 1 << 20) {
    try {
      read_file(file, most_bytes);
    } catch (const ReadError& error) {
      return error.sentence(file, "REMEDY");
    }
    return "nothing";
  }
};

TEST_F(WholeFile, IsReadByteByByte) {
  std::string bytes(200'000, 'x');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i % 251);
  EXPECT_EQ(read_file(put("bytes", bytes)), bytes);
  EXPECT_EQ(read_file(put("empty", "")), "");
  EXPECT_EQ(read_file(put("just", "12345"), 5), "12345");
}

TEST_F(WholeFile, OfProcIsReadThoughItsStatedLengthIsZero) {
  ASSERT_EQ(std::filesystem::file_size("/proc/self/status"), 0U);
  EXPECT_THAT(read_file("/proc/self/status"), StartsWith("Name:"));
  const std::size_t bytes = read_file("/proc/version").size();
  EXPECT_EQ(read_file("/proc/version", bytes).size(), bytes);
  EXPECT_THAT(refusal_of("/proc/version", bytes - 1), HasSubstr("is longer than"));
}

TEST_F(WholeFile, IsRefusedWithTheReason) {
  const std::string name = (folder() / "file").string();
  EXPECT_EQ(refusal_of(name), name + ": there is no such file: REMEDY");
  EXPECT_EQ(refusal_of(folder()), folder().string() + ": is not a regular file: REMEDY");
  ASSERT_EQ(::mkfifo(name.c_str(), 0600), 0);
  EXPECT_EQ(refusal_of(name), name + ": is not a regular file: REMEDY");  // rather than to wait for a writer
  const auto long_file = put("long", std::string(2049, ' '));
  EXPECT_EQ(refusal_of(long_file, 2048), long_file.string() + ": is longer than 2 KiB: REMEDY");
  EXPECT_EQ(refusal_of("/proc/self/mem"),
            "/proc/self/mem: cannot be read (Input/output error): check the file and its disk");
  if (::geteuid() == 0) return;  // root may read everything
  std::filesystem::permissions(long_file, std::filesystem::perms::none);
  EXPECT_THAT(refusal_of(long_file),
              HasSubstr(": cannot be opened (Permission denied): check its permissions"));
}

}  // namespace
}  // namespace mssim
