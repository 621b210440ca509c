// Looking for a case, for images or for a mesh in the folders of this machine: the list of one folder with a
// selected row, by keys and by mouse. What is done with what was found is its owner's.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/folders/folder_listing.h"
#include "app/widgets/controls.h"

namespace arthronaut::folders {

class FolderBrowser {
 public:
  // name: of its rows in the list of widgets, "NAME.FILE".
  explicit FolderBrowser(std::string name) : name_(std::move(name)) {}

  // Where it was last; the first time the user's own folder.
  void enter();
  void home();
  // The folder above. There the one that it came from is selected, so that opening goes back down.
  void up();
  void move_selection(int by);  // rows; stops at the ends
  // Goes into the selected folder; anything else is given to the caller.
  [[nodiscard]] std::optional<std::filesystem::path> open_selected();

  // Opens a field for a path, in the place of the folder's name: Tab completes, Enter goes there, Esc does
  // not.
  void type_path();
  [[nodiscard]] bool awaits_text() const { return typing_.takes_focus; }
  // To what was typed: into a folder; anything else is given to the caller. Where there is none the field
  // stays and typing_problem() says why.
  [[nodiscard]] std::optional<std::filesystem::path> go_to(const std::string& text);
  [[nodiscard]] const std::string& typing_problem() const { return typing_.problem; }

  [[nodiscard]] const std::filesystem::path& folder() const { return listing_.folder; }  // empty: not entered
  [[nodiscard]] bool has_rows() const { return !listing_.entries.empty(); }
  // The name of what is selected; empty: nothing is.
  [[nodiscard]] std::string selected() const;

  // take_folder: how the one who looks is told to take the folder itself, for images without an ending.
  // What was chosen by a click twice, where that is no folder to go into.
  [[nodiscard]] std::optional<std::filesystem::path> draw(const widgets::Ui& ui, widgets::Rect area,
                                                          const std::string& title,
                                                          const std::string& take_folder);

 private:
  void look_into(const std::filesystem::path& folder);
  [[nodiscard]] std::optional<std::filesystem::path> draw_typing(const widgets::Ui& ui,
                                                                 const widgets::Rect& line);

  struct Typing {
    bool is_open = false, takes_focus = false, takes_letters = false;
    std::string text, problem;
  };
  std::string name_;
  FolderListing listing_;
  std::size_t selected_ = 0;
  bool scrolls_to_selected_ = false;
  Typing typing_;
};

}  // namespace arthronaut::folders
