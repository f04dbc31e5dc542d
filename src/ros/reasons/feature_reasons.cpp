#include "ros/reasons/reason_rows.h"

namespace laparoscope_servo {

const std::vector<ReasonRow>& featureReasons() {
  static const std::vector<ReasonRow> rows{
      // Nothing is tracked.
      {{"nothing is selected"},
       "Nothing is selected that it could follow.",
       "Call its service select_features, or start it with selection:=.",
       "features.md#selection"},
      {{"no instrument is seen"}, "No instrument is seen.", "Nothing: it is found when it comes.", "instruments.md"},
      {{"reset"}, "What it followed was given up on demand.", "Select it again; instruments are found again."},
      {{"the stamp lies before the last one", "time jumped back"},
       "The time of the pictures jumped back, and what was followed is forgotten.",
       "Select it again; what is in the file selection is selected by itself."},
      {{"the image has another size or type than the one of the selection"},
       "The pictures have another size or colour than before.",
       "Select the features again."},
      {{"the camera is another one than that of the selection"},
       "The camera's calibration has changed.",
       "Select the object again."},
      // The feed.
      {{"the picture repeats"},
       "The same picture comes again and again: the feed stands still.",
       "Look at camera, grabber, network.",
       "pictures.md"},
      // A feature is not seen.
      {{"outside the image"}, "It has left the picture.", "Move the scope back."},
      {{"covered: too little of it shows the edge that was selected"},
       "Too little of its edge is seen.",
       "Take away what covers it, or wait; when its looks have changed, select it again."},
      {{"nothing near there looks like it: covered, gone, or merged with something"},
       "Nothing looks like it where it is expected.",
       "Take away what covers it; if it has moved away, select it again."},
      {{"what agrees may agree by chance"},
       "So many edges are there that some fit by chance.",
       "Wait for a sharper picture, or select a piece with clearer edges."},
      {{"what is seen does not determine it"},
       "What is seen of it does not tell where it is.",
       "Take away what covers it, or select more of it."},
      {{"the expected error is too large"},
       "It is seen, but its place is too uncertain.",
       "Wait for a sharper picture; the bound is edges/max_error."},
      {{"it would have jumped to something that looks different"},
       "What was found lies too far off, and looks different.",
       "Move slowly; if it has moved there, select it again."},
      {{"it would have changed its size or shape too fast"},
       "What was found has another size or shape.",
       "Wait, or select it again."},
      {{"the image shows it in two poses that cannot be told apart"},
       "Two poses of it fit the picture equally well.",
       "Move the scope until it shows another side."},
      {{"another feature was found in its place"},
       "Another feature is where it would be.",
       "Wait until they are apart, or select both again."},
      {{"found again, to be confirmed by the next images"},
       "It was found; it has to be found a few times in a row.",
       "Wait."},
  };
  return rows;
}

}  // namespace laparoscope_servo
