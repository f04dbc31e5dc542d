#include "laparoscope_servo/aesop/transport.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <thread>

#include "sim/arm/pty.h"
#include "support/error_text.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::aesop {
namespace {

class TransportTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.file(name); }

  static std::string errorOf(SerialTransport& transport, const std::string& port, int baud_rate = 38400) {
    return test_support::errorText<TransportError>([&] { transport.open(port, baud_rate); });
  }
  // What `read` gives until `size` bytes are there, or a second has passed.
  template <typename Read>
  static Bytes collect(std::size_t size, Read read) {
    Bytes bytes;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (bytes.size() < size && std::chrono::steady_clock::now() < end) {
      const Bytes piece = read();
      bytes.insert(bytes.end(), piece.begin(), piece.end());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return bytes;
  }

  const test_support::TemporaryFolder folder_;
  std::unique_ptr<sim::Pty> pty_ = std::make_unique<sim::Pty>(path("port"));
};

TEST_F(TransportTest, everyByteGoesBothWaysUnchanged) {
  SerialTransport transport;
  transport.open(path("port"), 38400);
  EXPECT_FALSE(transport.lowLatency()) << "a pty has no such setting, and works without";
  Bytes all;
  for (int byte = 0; byte < 256; ++byte) all.push_back(static_cast<std::uint8_t>(byte));
  transport.write(all);
  EXPECT_EQ(collect(all.size(),
                    [&] {
                      transport.write({});
                      return pty_->read();
                    }),
            all);
  pty_->write(all);
  EXPECT_EQ(collect(all.size(), [&] { return transport.read(); }), all);
  EXPECT_TRUE(transport.read().empty()) << "reading does not wait";
}

TEST_F(TransportTest, noSuchPort) {
  SerialTransport transport;
  const std::string error = errorOf(transport, path("nothing"));
  EXPECT_NE(error.find(path("nothing")), std::string::npos) << error;
  EXPECT_NE(error.find("no such port"), std::string::npos) << error;
  EXPECT_FALSE(transport.isOpen());
}

// What the system refuses is an error of the port like any other: the node tries again, and does not end.
TEST_F(TransportTest, noDescriptorsLeft) {
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  const int next = ::dup(0);
  ASSERT_GE(next, 0);
  ::close(next);
  std::string error;
  for (int spare = 0; spare < 6; ++spare) {  // each of the descriptors that opening needs is the one that is missing
    rlimit tight = limit;
    tight.rlim_cur = static_cast<rlim_t>(next + spare);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &tight), 0);
    SerialTransport transport;
    error = errorOf(transport, path("port"));
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    if (error.empty()) break;
    EXPECT_NE(error.find(path("port")), std::string::npos) << error;
  }
  EXPECT_EQ(error, "") << "with enough of them it opens";
}

TEST_F(TransportTest, notATerminal) {
  std::ofstream(path("file")) << "text";
  SerialTransport transport;
  for (const std::string& port : {path("file"), folder_.path(), std::string("/dev/null")}) {
    const std::string error = errorOf(transport, port);
    EXPECT_NE(error.find("no serial port"), std::string::npos) << error;
    EXPECT_FALSE(transport.isOpen());
  }
}

TEST_F(TransportTest, inUse) {
  SerialTransport first;
  first.open(path("port"), 38400);
  SerialTransport second;
  const std::string error = errorOf(second, path("port"));
  EXPECT_NE(error.find("in use"), std::string::npos) << error;
  // The attempt has not disturbed the first one, which goes on, and frees the port when it ends.
  first.write({1, 2, 3});
  EXPECT_EQ(collect(3,
                    [&] {
                      first.write({});
                      return pty_->read();
                    }),
            (Bytes{1, 2, 3}));
  first.close();
  EXPECT_EQ(errorOf(second, path("port")), "");
}

TEST_F(TransportTest, aLineThatGoesAwayIsAnErrorAndCloses) {
  SerialTransport transport;
  transport.open(path("port"), 38400);
  pty_.reset();
  std::string error;
  try {
    collect(1, [&] { return transport.read(); });
  } catch (const TransportError& gone) {
    error = gone.what();
  }
  EXPECT_NE(error.find("the line has gone"), std::string::npos) << error;
  EXPECT_FALSE(transport.isOpen());
  EXPECT_TRUE(transport.read().empty()) << "a closed port is silent";
  pty_ = std::make_unique<sim::Pty>(path("port"));
  EXPECT_EQ(errorOf(transport, path("port")), "") << "and can be opened again";
}

TEST_F(TransportTest, aLineThatTakesNothingIsAnError) {
  SerialTransport transport;
  transport.open(path("port"), 38400);
  EXPECT_THROW(
      {
        for (int k = 0; k < 10000; ++k) transport.write(Bytes(100, 0x55));  // nobody reads at the far end
      },
      TransportError);
  EXPECT_FALSE(transport.isOpen());
}

TEST_F(TransportTest, oldBytesOfALineAreThrownAway) {
  pty_->write({1, 2, 3, 4});
  SerialTransport transport;
  transport.open(path("port"), 38400);
  pty_->write({9});
  EXPECT_EQ(collect(1, [&] { return transport.read(); }), (Bytes{9}));
}

}  // namespace
}  // namespace laparoscope_servo::aesop
