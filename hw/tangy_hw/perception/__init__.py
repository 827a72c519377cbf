"""Recognition of cards, faces and requests for help, mostly in camera images."""
