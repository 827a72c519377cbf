"""Activities as declared data: the file format, its reader, and the interpreter."""
