// What can be read on the display, by OCR.
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/command_output.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::test_support {

// One thread, for those of OpenMP spin on a busy machine. Page segmentation 11: text anywhere, in no order.
inline std::string textOnDisplay(const std::string& form = "") {
  const TemporaryFolder folder;
  const std::string picture = folder.file("display.png");
  const CommandOutput read = outputOf("import -silent -window root " + picture + " && OMP_THREAD_LIMIT=1 tesseract " +
                                      picture + " - --psm 11 " + form + " 2>/dev/null");
  if (read.status != 0) throw std::runtime_error("the display cannot be read: " + read.text);
  return read.text;
}

// A line for each word: six numbers, then left, top, width and height in px, confidence, and the word.
inline std::string wordsOnDisplay() {
  return textOnDisplay("tsv");
}

// The first of these that cannot be read in it; empty when all can.
inline std::string notRead(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (text.find(word) == std::string::npos) return word;
  }
  return "";
}

// The text of the display when all of these words can be read in it, or the last one that was read.
inline std::string readUntil(const std::vector<std::string>& words, double seconds = 60.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::string text;
  do {
    text = textOnDisplay();
  } while (!notRead(text, words).empty() && std::chrono::steady_clock::now() < end);
  return text;
}

}  // namespace laparoscope_servo::test_support
