// parameter_pages FOLDER: writes the files of ros/parameter_pages.h into the package's folder.
#include "ros/parameter_pages.h"

#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: parameter_pages FOLDER\n";
    return 2;
  }
  try {
    for (const laparoscope_servo::ParameterPage& page : laparoscope_servo::parameterPages()) {
      const std::string name = std::string(argv[1]) + "/" + page.file;
      std::ostringstream old;
      old << std::ifstream(name).rdbuf();
      const std::string text = withParameters(page, old.str());
      if (text == old.str()) continue;
      std::ofstream(name) << text;
      std::cout << page.file << '\n';
    }
  } catch (const std::exception& error) {
    std::cerr << "parameter_pages: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
