"""Activities as declared data: what a file may say, how it is read, and the one interpreter."""
