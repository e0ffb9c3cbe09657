"""The implementation of the package ``babybench``; import that."""
