"""Values put into sentences for people, the same on screens, in lines and on pages."""
