#include "bench/support/arguments.h"

#include <boost/program_options.hpp>
#include <iostream>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::bench {

namespace {

std::vector<double> numbers(const std::string& text, char separator) {
  std::vector<double> result;
  std::istringstream stream(text);
  std::string part;
  while (std::getline(stream, part, separator)) {
    std::size_t used = 0;
    double number = 0.0;
    try {
      number = std::stod(part, &used);
    } catch (const std::logic_error&) {
      used = 0;
    }
    if (used == 0 || used != part.size())
      throw std::invalid_argument("\"" + part + "\" in \"" + text + "\" is no number");
    result.push_back(number);
  }
  return result;
}

}  // namespace

geometry::Rectangle parseRoi(const std::string& text) {
  const std::vector<double> n = numbers(text, ',');
  if (n.size() != 4) throw std::invalid_argument("roi \"" + text + "\", expected x,y,width,height");
  return {n[0], n[1], n[2], n[3]};
}

std::vector<double> parseRange(const std::string& text) {
  const std::vector<double> n = numbers(text, ':');
  if (n.empty() || n.size() > 3) throw std::invalid_argument("range \"" + text + "\", expected FIRST[:LAST[:STEP]]");
  const double step = n.size() == 3 ? n[2] : 1.0;
  const double last = n.size() > 1 ? n[1] : n[0];
  if (!(step > 0.0) || !(last >= n[0])) throw std::invalid_argument("range \"" + text + "\" is empty");
  std::vector<double> result;
  for (int k = 0; n[0] + k * step <= last + 1e-9 * step; ++k) result.push_back(n[0] + k * step);
  return result;
}

std::optional<int> parse(int argc, char** argv, const boost::program_options::options_description& options,
                         const char* positional, int most, const std::function<bool()>& complete) {
  namespace po = boost::program_options;
  po::positional_options_description positions;
  positions.add(positional, most);
  po::variables_map given;
  po::store(po::command_line_parser(argc, argv).options(options).positional(positions).run(), given);
  po::notify(given);
  const bool help = given.count("help") > 0;
  if (!help && complete()) return {};
  std::cout << options;
  return help ? 0 : 2;
}

std::ofstream create(const std::string& file) {
  std::ofstream stream;
  if (file.empty()) return stream;
  stream.rdbuf()->pubsetbuf(nullptr, 0);  // so that a full disk is known at once, and nothing is left for the end
  stream.open(file);
  if (!stream) throw std::runtime_error(file + ": cannot be written");
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  return stream;
}

int run(const char* program, const std::function<int()>& body) {
  try {
    cv::setNumThreads(1);
    return body();
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace laparoscope_servo::bench
