// Choosing a file, inside the window.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace brume {

/// A modal list of folders and files with a field for the path. One at a time.
class FileDialog {
 public:
  struct Request {
    std::string title;                    ///< also the name under which tests find it: "Open", "Save as"
    std::vector<std::string> extensions;  ///< shown, lower case, with the dot; empty: all
    bool save = false;                    ///< a new name may be typed; an existing one is asked about
    std::string path;                     ///< what stands in the field at first
    std::function<void(const std::string&)> chosen;
  };

  void open(Request request);
  /// Once per frame, outside all windows.
  void draw();
  bool is_open() const { return open_; }

 private:
  struct Entry {
    std::string name;
    bool folder;
  };

  void list_folder();
  void go_to(const std::string& folder);
  void accept();
  bool shown(const std::string& name) const;

  Request request_;
  std::string field_;   // the path as typed
  std::string folder_;  // the one listed
  std::vector<Entry> entries_;
  std::string problem_;
  bool open_ = false, opening_ = false, confirm_ = false;
};

}  // namespace brume
