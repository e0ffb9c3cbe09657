"""The implementation of the packages ``babybench`` and ``mimoEnv``; import those."""
