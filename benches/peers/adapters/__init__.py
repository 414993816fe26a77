"""The works in the words of each library, one file for each."""
