#include "ros/reasons/reason_rows.h"

namespace laparoscope_servo {

const std::vector<ReasonRow>& playerReasons() {
  static const std::vector<ReasonRow> rows{
      {{"' breaks off: it was cut, or the recorder was killed ("},
       "The bag breaks off: it was cut, or the recorder was killed.",
       "Run rosbag reindex on the file; then press \"Again\".",
       "recordings.md#bags"},
      {{"' is damaged behind image "},
       "The bag is damaged here.",
       "Look at what comes before by \"Again\"; rosbag reindex may repair the rest.",
       "recordings.md#bags"},
      {{"' is empty, expected a bag"}, "There is nothing in the file.", "Choose another one."},
      {{"' is no bag of format 2.0, whatever its name says"},
       "The file is no bag, whatever its name says.",
       "Choose a bag; a video must not end in .bag."},
      {{"' is no bag, expected bags where several inputs are given"},
       "Only bags can be several.",
       "Give one video or folder, or bags alone."},
      {{"' has no topic with images"},
       "There are no pictures in the bag.",
       "Choose another one: record.launch, or rosbag record of the camera's images, writes them."},
      {{"' has no topic '", "' of bag '…' is of type "},
       "The bag has no pictures, or no intrinsics, under that name.",
       "Correct image_topic:= or camera_info_topic:=."},
      {{"' has several topics with images"}, "There are several cameras in the bag.", "Choose one by image_topic:=."},
      {{"' does not exist, expected a bag, a video or a folder of images"},
       "There is no such file.",
       "Correct what stands after bag:= or video:=."},
      {{"folder '…' cannot be read: ", "' cannot be read"},
       "The file or folder may not be read.",
       "Look at whom it belongs to."},
      {{"' has no images, expected files ending in "}, "There are no pictures in the folder.", "Choose another one."},
      {{"' cannot be opened as a video (…), expected a bag, a folder of images or a whole video",
        "' cannot be decoded as a video in ", "' has no picture that can be decoded"},
       "The file is no video that can be read.",
       "Does a player of videos show it? If not, it is damaged."},
      {{"' has no image after "}, "Nothing is left of the recording.", "Give an earlier start:=."},
  };
  return rows;
}

}  // namespace laparoscope_servo
