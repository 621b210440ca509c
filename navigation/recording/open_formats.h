// Inner header: poses.csv and guidance.csv of a session, written frame by frame. They grow as *.csv.part,
// since half a table must not pass for a whole one, and get their names at the end: an end that takes the
// same time after a minute and after hours. What a crash leaves unnamed is in session.sqlite all the same.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/strokes/poses_file.h"

namespace arthronaut::recording {

// One thread at a time.
class OpenFormats {
 public:
  // Begins both files, of what these tools show. Throws IoError, as every other member.
  OpenFormats(const std::filesystem::path& session_folder, const tools::ToolSet& tools);

  void append(const pipeline::FrameResult& result);
  // Hands over to the system what is buffered; once in a while is enough.
  void flush();
  // Gives the files their names. Nothing can be appended afterwards.
  void finish();

 private:
  struct Table {
    explicit Table(const std::filesystem::path& named);
    void check() const;
    void finish();
    std::filesystem::path file, part;
    std::ofstream stream;
    std::string text;  // of one frame, kept between frames for its memory
  };

  tools::ToolSet tools_;
  Table poses_, guidance_;
  std::vector<strokes::PoseRow> rows_;
};

}  // namespace arthronaut::recording
